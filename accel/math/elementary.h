/// \file  The project's own sine, cosine, arc cosine and arc tangent, host and device.
///
/// The C library's differ in the last bit between systems and devices; these are plain float
/// arithmetic, so that images are the same bits everywhere. Minimax polynomials of the Cephes
/// library (S. L. Moshier, 1992: sinf, cosf, asinf, atanf); errors are measured in tests.
#pragma once

#include "accel/math/vec.h"

namespace plumb {

struct SinCos {
    float sin, cos;
};

namespace detail {

/// Sine and cosine for |x| <= pi/4.
RT_HD inline SinCos sincos_octant(float x) {
    const float z = x * x;
    const float s = ((-1.9515295891e-4f * z + 8.3321608736e-3f) * z - 1.6666654611e-1f) * z * x + x;
    const float c =
        ((2.443315711809948e-5f * z - 1.388731625493765e-3f) * z + 4.166664568298827e-2f) * z * z -
        0.5f * z + 1;
    return {s, c};
}

} // namespace detail

/// Sine and cosine of 2 pi u for u in [-1, 1]; absolute error below 2e-7.
RT_HD inline SinCos sincos_turns(float u) {
    const float quarter = static_cast<float>(static_cast<int>(4 * u + (u < 0 ? -0.5f : 0.5f)));
    const SinCos r = detail::sincos_octant((u - 0.25f * quarter) * (2 * pi));
    const int q = static_cast<int>(quarter) & 3;
    const float s = (q & 1) != 0 ? r.cos : r.sin;
    const float c = (q & 1) != 0 ? r.sin : r.cos;
    return {(q & 2) != 0 ? -s : s, ((q + 1) & 2) != 0 ? -c : c};
}

/// Sine and cosine of x in radians, |x| <= 2 pi; absolute error below 1e-6 (x / 2 pi is rounded).
RT_HD inline SinCos sincos_radians(float x) { return sincos_turns(x * inv_two_pi); }

/// Angle of (x, y) in (-pi, pi], 0 for (0, 0); relative error below 4e-7.
RT_HD inline float atan2(float y, float x) {
    const float ax = std::fabs(x), ay = std::fabs(y);
    const bool steep = ay > ax;
    const float numerator = steep ? ax : ay, denominator = steep ? ay : ax;
    float q = denominator > 0 ? numerator / denominator : 0; // in [0, 1]
    const bool upper = q > 0.41421356f;                      // tan(pi/8)
    if (upper)
        q = (q - 1) / (q + 1);
    const float z = q * q;
    float angle = (((8.05374449538e-2f * z - 1.38776856032e-1f) * z + 1.99777106478e-1f) * z -
                   3.33329491539e-1f) *
                      z * q +
                  q;
    if (upper)
        angle = 0.78539816339744830962f + angle;
    if (steep)
        angle = 1.57079632679489661923f - angle;
    if (std::signbit(x))
        angle = pi - angle;
    return std::signbit(y) ? -angle : angle;
}

} // namespace plumb
