/// \file  Marks functions that compile for the host and, under nvcc, for the device.
#pragma once

#include <cassert>

#ifdef __CUDACC__
#define RT_HD __host__ __device__
#else
#define RT_HD
#endif

/// Checks a condition that holds unless the program itself is wrong. Compiled out in release
/// builds.
#ifdef __CUDA_ARCH__
#define RT_ASSERT(condition) ((void)0)
#else
#define RT_ASSERT(condition) assert(condition)
#endif
