// How the executor at hand stores rows of contact candidates (State::grains).
#pragma once

#include "exec/exec.hpp"

#if defined(__CUDACC__)
#include "exec/rows_cuda.hpp"
#else
#include "exec/rows_cpu.hpp"
#endif
