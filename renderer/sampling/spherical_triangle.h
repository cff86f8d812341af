/// \file  Uniform sampling of the solid angle of a triangle, host and device.
///
/// J. Arvo, "Stratified Sampling of Spherical Triangles", SIGGRAPH 1995; solid angle after A. Van
/// Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", 1983. In double: in float the
/// formulas lose all digits beside slivers and within 1e-3 of a triangle's size from it, where a
/// mesh light touches what it lights.
#pragma once

#include "accel/math/elementary.h"

namespace plumb {

namespace detail {

RT_HD inline float to_float(float x) { return x; }
RT_HD inline float to_float(double x) { return static_cast<float>(x); }

/// A vector in double, for what cancels.
struct Vec3d {
    double x, y, z;

    RT_HD Vec3d(double a, double b, double c) : x(a), y(b), z(c) {}
    RT_HD explicit Vec3d(Vec3 v)
        : x(static_cast<double>(v.x)), y(static_cast<double>(v.y)), z(static_cast<double>(v.z)) {}
};
RT_HD inline Vec3d operator+(Vec3d a, Vec3d b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
RT_HD inline Vec3d operator-(Vec3d a, Vec3d b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
RT_HD inline Vec3d operator*(Vec3d a, double s) { return {a.x * s, a.y * s, a.z * s}; }
RT_HD inline double dot(Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
RT_HD inline Vec3d cross(Vec3d a, Vec3d b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Unit vector; a zero vector stays one.
RT_HD inline Vec3d unit(Vec3d a) {
    const double length2 = dot(a, a);
    return length2 > 0 ? a * (1 / std::sqrt(length2)) : a;
}

template <class Real> struct SinCosOf { Real sin, cos; };

/// Sine and cosine with the error of float in the angle, but on the unit circle as exactly as Real
/// can be.
template <class Real> RT_HD inline SinCosOf<Real> sincos_unit(float angle) {
    const SinCos f = sincos_radians(angle);
    if constexpr (sizeof(Real) == sizeof(float)) {
        return {f.sin, f.cos};
    } else {
        const Real s = f.sin, c = f.cos;
        const Real scale = 1 / std::sqrt(s * s + c * c);
        return {s * scale, c * scale};
    }
}

} // namespace detail

/// A triangle seen from a point.
class SphericalTriangle {
  public:
    /// `corner`: relative to the point; the triangle is corner, corner + edge1, corner + edge2.
    RT_HD SphericalTriangle(Vec3 corner, Vec3 edge1, Vec3 edge2)
        : corner_(corner), edge1_(edge1), edge2_(edge2), a_(detail::unit(corner_)),
          b_(detail::unit(corner_ + edge1_)), c_(detail::unit(corner_ + edge2_)) {
        // From the edges, so that a far triangle does not cancel: a . (b x c) = a . (e1 x e2).
        const double volume = std::fabs(dot(a_, cross(b_ - a_, c_ - a_)));
        const double sum = 1 + dot(a_, b_) + dot(b_, c_) + dot(c_, a_);
        solid_angle_ = 2 * atan2(static_cast<float>(volume), static_cast<float>(sum));
    }

    /// Steradians, in [0, 2 pi].
    [[nodiscard]] RT_HD float solid_angle() const { return solid_angle_; }

    /// Point of the triangle as corner + s edge1 + t edge2. Its direction is uniform over the solid
    /// angle for u uniform in [0,1)^2.
    [[nodiscard]] RT_HD Vec2 sample(Vec2 u) const {
        const detail::Vec3d d = direction(u);
        // Where it meets the plane: barycentrics after Möller and Trumbore.
        const detail::Vec3d p = cross(d, edge2_), o = corner_ * -1;
        const double det = dot(edge1_, p);
        const float s = clamp(static_cast<float>(dot(o, p) / det), 0, 1);
        return {s, clamp(static_cast<float>(dot(d, cross(o, edge1_)) / det), 0, 1 - s)};
    }

  private:
    RT_HD detail::Vec3d direction(Vec2 u) const {
        const detail::Vec3d n_ab = detail::unit(cross(a_, b_)), n_ac = detail::unit(cross(a_, c_));
        // Angle alpha at vertex a between the two great circles.
        const double cos_alpha = dot(n_ab, n_ac);
        const detail::Vec3d turn = cross(n_ab, n_ac);
        const double sin_alpha = std::sqrt(dot(turn, turn));
        const double cos_side = dot(a_, b_);
        // s, t: sine and cosine of (u S - alpha).
        const auto area = detail::sincos_unit<double>(u.x * solid_angle_);
        const double s = area.sin * cos_alpha - area.cos * sin_alpha;
        const double t = area.cos * cos_alpha + area.sin * sin_alpha;
        const double p = t - cos_alpha, r = s + sin_alpha * cos_side;
        const double above = (r * t - p * s) * cos_alpha - r;
        const double below = (r * s + p * t) * sin_alpha;
        double q = below != 0 ? above / below : 1;
        q = q > 1 ? 1 : q < -1 ? -1 : q;
        // c' on the arc from a to c, then the point on the arc from b to c'.
        const detail::Vec3d c = a_ * q + detail::unit(c_ - a_ * dot(c_, a_)) * std::sqrt(1 - q * q);
        const detail::Vec3d arm = c - b_;
        const double drop = 0.5 * static_cast<double>(u.y) * dot(arm, arm); // 1 - cos from b
        const double sine2 = drop * (2 - drop);
        return b_ * (1 - drop) +
               detail::unit(c - b_ * dot(c, b_)) * std::sqrt(sine2 > 0 ? sine2 : 0);
    }

    detail::Vec3d corner_, edge1_, edge2_;
    detail::Vec3d a_, b_, c_; ///< unit vectors towards the vertices
    float solid_angle_;
};

} // namespace plumb
