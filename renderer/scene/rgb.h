/// \file  Scene-linear colours with Rec. 709 primaries and a D65 white, host and device.
#pragma once

#include "accel/math/vec.h"

namespace plumb {

struct Rgb {
    float r = 0, g = 0, b = 0;

    constexpr bool operator==(const Rgb&) const = default;
};

RT_HD constexpr Rgb operator+(Rgb a, Rgb b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
RT_HD constexpr Rgb operator*(Rgb a, Rgb b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
RT_HD constexpr Rgb operator*(Rgb a, float s) { return {a.r * s, a.g * s, a.b * s}; }
RT_HD constexpr Rgb& operator+=(Rgb& a, Rgb b) { return a = a + b; }
RT_HD constexpr Rgb& operator*=(Rgb& a, Rgb b) { return a = a * b; }
RT_HD constexpr Rgb& operator*=(Rgb& a, float s) { return a = a * s; }

/// Rec. 709 luminance.
RT_HD constexpr float luminance(Rgb c) {
    return 0.212671f * c.r + 0.715160f * c.g + 0.072169f * c.b;
}
RT_HD constexpr float max_component(Rgb c) { return max(c.r, max(c.g, c.b)); }
RT_HD constexpr bool is_black(Rgb c) { return c.r == 0 && c.g == 0 && c.b == 0; }

} // namespace plumb
