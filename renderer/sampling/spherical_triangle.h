/// \file  Uniform sampling of the solid angle of a triangle, host and device.
///
/// J. Arvo, "Stratified Sampling of Spherical Triangles", SIGGRAPH 1995; solid angle after A. Van
/// Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", 1983.
#pragma once

#include "accel/math/elementary.h"

namespace plumb {

/// A triangle seen from a point, as three unit vectors towards its vertices.
class SphericalTriangle {
  public:
    /// Vertices relative to the point, none of them zero.
    RT_HD SphericalTriangle(Vec3 a, Vec3 b, Vec3 c)
        : a_(normalize(a)), b_(normalize(b)), c_(normalize(c)) {
        // From the edges, so that a far triangle does not cancel: a . (b x c) = a . (e1 x e2).
        const float volume = std::fabs(dot(a_, cross(b_ - a_, c_ - a_)));
        solid_angle_ = 2 * atan2(volume, 1 + dot(a_, b_) + dot(b_, c_) + dot(c_, a_));
    }

    /// Steradians, in [0, 2 pi].
    [[nodiscard]] RT_HD float solid_angle() const { return solid_angle_; }

    /// Unit direction uniform over the solid angle for u uniform in [0,1)^2.
    [[nodiscard]] RT_HD Vec3 sample(Vec2 u) const {
        const Vec3 n_ab = cross(a_, b_), n_ac = cross(a_, c_);
        // Angle alpha at vertex a between the two great circles.
        const float lengths = std::sqrt(dot(n_ab, n_ab) * dot(n_ac, n_ac));
        const float cos_alpha = clamp(dot(n_ab, n_ac) / lengths, -1, 1);
        const float sin_alpha = length(cross(n_ab, n_ac)) / lengths;
        const float cos_side = dot(a_, b_);
        // s, t: sine and cosine of (u S - alpha).
        const SinCos area = sincos_radians(u.x * solid_angle_);
        const float s = area.sin * cos_alpha - area.cos * sin_alpha;
        const float t = area.cos * cos_alpha + area.sin * sin_alpha;
        const float p = t - cos_alpha, r = s + sin_alpha * cos_side;
        const float above = (r * t - p * s) * cos_alpha - r;
        const float below = (r * s + p * t) * sin_alpha;
        const float q = below != 0 ? clamp(above / below, -1, 1) : 1;
        // c' on the arc from a to c, then the point on the arc from b to c'.
        const Vec3 towards_c = safe_normalize(c_ - dot(c_, a_) * a_);
        const Vec3 c = q * a_ + std::sqrt(max(0.0f, 1 - q * q)) * towards_c;
        const Vec3 arm = c - b_;
        const float drop = u.y * 0.5f * dot(arm, arm); // 1 - cos of the angle from b
        const Vec3 towards = safe_normalize(c - dot(c, b_) * b_);
        return normalize((1 - drop) * b_ + std::sqrt(max(0.0f, drop * (2 - drop))) * towards);
    }

  private:
    Vec3 a_, b_, c_;
    float solid_angle_;
};

} // namespace plumb
