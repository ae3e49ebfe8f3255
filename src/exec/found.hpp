// How the executor at hand turns "i has found j" into rows: collect(finder, items, tells, list), see neighbors/list.hpp.
#pragma once

#include "exec/exec.hpp"

#if defined(__CUDACC__)
#include "exec/found_cuda.hpp"
#else
#include "exec/found_cpu.hpp"
#endif
