/// \file  Counting bits, host and device.
#pragma once

#include "accel/math/host_device.h"

#include <bit>
#include <cstdint>

namespace plumb {

/// Number of ones.
RT_HD inline std::uint32_t ones(std::uint32_t x) {
#ifdef __CUDA_ARCH__
    return static_cast<std::uint32_t>(__popc(static_cast<int>(x)));
#else
    return static_cast<std::uint32_t>(std::popcount(x));
#endif
}

/// Place of the highest one; x > 0.
RT_HD inline std::uint32_t highest_one(std::uint32_t x) {
#ifdef __CUDA_ARCH__
    return static_cast<std::uint32_t>(31 - __clz(static_cast<int>(x)));
#else
    return static_cast<std::uint32_t>(31 - std::countl_zero(x));
#endif
}

/// Place of the lowest one; x > 0.
RT_HD inline std::uint32_t lowest_one(std::uint32_t x) {
#ifdef __CUDA_ARCH__
    return static_cast<std::uint32_t>(__ffs(static_cast<int>(x)) - 1);
#else
    return static_cast<std::uint32_t>(std::countr_zero(x));
#endif
}

} // namespace plumb
