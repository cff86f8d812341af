/// \file  Choice among n items by weight, host and device.
#pragma once

#include "accel/math/host_device.h"

#include <cstdint>
#include <span>

namespace plumb {

/// An item chosen by inverting a cumulative distribution.
struct DiscreteSample {
    std::uint32_t index;
    float probability;
};

/// `cdf`: n + 1 non-decreasing numbers from 0 to 1; item i has probability cdf[i+1] - cdf[i].
RT_HD inline float discrete_probability(std::span<const float> cdf, std::uint32_t i) {
    return cdf[i + 1] - cdf[i];
}

/// u in [0,1). Items of probability 0 are never chosen.
RT_HD inline DiscreteSample sample_discrete(std::span<const float> cdf, float u) {
    std::uint32_t low = 0, high = static_cast<std::uint32_t>(cdf.size()) - 1;
    while (high - low > 1) { // cdf[low] <= u < cdf[high]
        const std::uint32_t middle = low + (high - low) / 2;
        if (cdf[middle] <= u)
            low = middle;
        else
            high = middle;
    }
    return {low, discrete_probability(cdf, low)};
}

} // namespace plumb
