// The primitives every stage is written in. One source, two executors: oneTBB (namespace cpu), CUDA (namespace cuda).
// The namespaces differ so that the linker never merges the two compilers' versions of one inline function.
#pragma once

#if defined(__CUDACC__)
#define GRAINRAY_EXEC cuda
#include "exec/cuda.hpp"
#else
#define GRAINRAY_EXEC cpu
#include "exec/cpu.hpp"
#endif
