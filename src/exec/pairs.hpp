// The pair loop of the executor at hand; the law is the same source on both.
#pragma once

#include "exec/exec.hpp"

#if defined(__CUDACC__)
#include "exec/pairs_cuda.hpp"
#else
#include "exec/pairs_cpu.hpp"
#endif
