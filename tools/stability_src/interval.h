/// \file  Confidence intervals of failure rates.
#pragma once

#include <cstdint>

namespace plumb::stability {

struct RateInterval {
    double low, high;
};

/// Wilson's score interval at 95 % (E. B. Wilson, JASA 22, 1927). With no failures it is
/// [0, 3.84 / (trials + 3.84)]; without trials it is [0, 1].
[[nodiscard]] RateInterval wilson_interval(std::uint64_t failures, std::uint64_t trials);

} // namespace plumb::stability
