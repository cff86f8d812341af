/// \file  Maps from the unit square to directions, with their pdfs, host and device.
#pragma once

#include "accel/math/elementary.h"

namespace plumb {

/// A direction in a local frame (z the normal) with its pdf per solid angle.
struct DirectionSample {
    Vec3 direction;
    float pdf;
};

/// Point of the unit circle at `turns` of a full turn, times r.
RT_HD inline Vec2 polar(float r, float turns) {
    const SinCos a = sincos_turns(turns);
    return {r * a.cos, r * a.sin};
}

/// Uniform over the upper hemisphere: z = u.x; pdf 1 / (2 pi).
RT_HD inline DirectionSample sample_uniform_hemisphere(Vec2 u) {
    const float z = u.x;
    const Vec2 p = polar(std::sqrt(max(0.0f, 1 - z * z)), u.y);
    return {{p.x, p.y, z}, inv_two_pi};
}
RT_HD inline float uniform_hemisphere_pdf(float cos_theta) {
    return cos_theta > 0 ? inv_two_pi : 0;
}

/// Cosine-distributed over the upper hemisphere: z = sqrt(1 - u.x); pdf z / pi.
RT_HD inline DirectionSample sample_cosine_hemisphere(Vec2 u) {
    const float z = std::sqrt(1 - u.x);
    const Vec2 p = polar(std::sqrt(u.x), u.y);
    return {{p.x, p.y, z}, z * inv_pi};
}
RT_HD inline float cosine_hemisphere_pdf(float cos_theta) {
    return cos_theta > 0 ? cos_theta * inv_pi : 0;
}

/// Uniform over the whole sphere; pdf 1 / (4 pi).
RT_HD inline DirectionSample sample_uniform_sphere(Vec2 u) {
    const float z = 1 - 2 * u.x;
    const Vec2 p = polar(std::sqrt(max(0.0f, 1 - z * z)), u.y);
    return {{p.x, p.y, z}, 0.5f * inv_two_pi};
}

/// 1 - cos of the half angle of a cone with the given squared sine, without cancellation.
RT_HD inline float one_minus_cos(float sin2) { return sin2 / (1 + std::sqrt(max(0.0f, 1 - sin2))); }

/// Uniform over the cone around +z with 1 - cos(half angle) = `extent`; pdf 1 / (2 pi extent).
RT_HD inline DirectionSample sample_cone(Vec2 u, float extent) {
    const float drop = u.x * extent; // 1 - cos(theta)
    const Vec2 p = polar(std::sqrt(max(0.0f, drop * (2 - drop))), u.y);
    return {{p.x, p.y, 1 - drop}, inv_two_pi / extent};
}

/// Barycentrics (weights of the second and third vertex) uniform over a triangle.
RT_HD inline Vec2 sample_triangle(Vec2 u) {
    const float root = std::sqrt(u.x);
    return {root * (1 - u.y), root * u.y};
}

} // namespace plumb
