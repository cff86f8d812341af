#include "tools/stability_src/interval.h"

#include <algorithm>
#include <cmath>

namespace plumb::stability {

RateInterval wilson_interval(std::uint64_t failures, std::uint64_t trials) {
    if (trials == 0)
        return {0, 1};
    constexpr double z = 1.959963984540054; // two-sided 95 %
    const double n = static_cast<double>(trials), rate = static_cast<double>(failures) / n;
    const double middle = rate + z * z / (2 * n);
    const double half = z * std::sqrt(rate * (1 - rate) / n + z * z / (4 * n * n));
    const double scale = 1 + z * z / n;
    return {failures == 0 ? 0.0 : std::max(0.0, (middle - half) / scale),
            failures == trials ? 1.0 : std::min(1.0, (middle + half) / scale)};
}

} // namespace plumb::stability
