/// \file  The sRGB transfer function (IEC 61966-2-1).
#pragma once

#include <cmath>

namespace plumb {

/// Linear value of an encoded one, [0,1] -> [0,1]; odd and unbounded outside.
[[nodiscard]] inline float srgb_to_linear(float encoded) {
    const double s = std::abs(static_cast<double>(encoded));
    const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    return static_cast<float>(std::copysign(linear, static_cast<double>(encoded)));
}

} // namespace plumb
