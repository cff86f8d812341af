/// \file  Uniform sampling of the solid angle of a rectangle, host and device.
///
/// C. Ureña, M. Fajardo, A. King, "An Area-Preserving Parametrization for Spherical Rectangles",
/// EGSR 2013. The solid angle itself comes from the triple products of its two triangles (A. Van
/// Oosterom, J. Strackee 1983), which keeps its relative accuracy for small rectangles, where the
/// sum of four angles minus 2 pi cancels.
///
/// Close to the plane of the rectangle and beside long strips both cancel in float (a strip of
/// 1e-4 : 1 seen from its own width: 11 times the solid angle); such views are computed in double.
#pragma once

#include "renderer/sampling/spherical_triangle.h"

namespace plumb {

namespace detail {

/// A rectangle seen from the origin: x0 <= x <= x1, y0 <= y <= y1, z = z0 < 0.
template <class Real> struct RectangleView {
    Real x0 = 0, y0 = 0, x1 = 0, y1 = 0, z0 = 0;

    /// Steradians. `sound`: whether no sum lost more than two digits.
    RT_HD float solid_angle(bool& sound) const {
        const Real z2 = z0 * z0;
        const Real la = std::sqrt(x0 * x0 + y0 * y0 + z2), lb = std::sqrt(x1 * x1 + y0 * y0 + z2);
        const Real lc = std::sqrt(x1 * x1 + y1 * y1 + z2), ld = std::sqrt(x0 * x0 + y1 * y1 + z2);
        const Real ab = x0 * x1 + y0 * y0 + z2, bc = x1 * x1 + y0 * y1 + z2;
        const Real cd = x1 * x0 + y1 * y1 + z2, da = x0 * x0 + y1 * y0 + z2;
        const Real ac = x0 * x1 + y0 * y1 + z2;
        const Real volume = -z0 * (x1 - x0) * (y1 - y0);
        const Real product_abc = la * lb * lc, product_acd = la * lc * ld;
        const Real abc = product_abc + ab * lc + bc * la + ac * lb;
        const Real acd = product_acd + ac * ld + cd * la + da * lc;
        constexpr Real lost = 0.01f;
        sound = (abc > lost * product_abc) & (acd > lost * product_acd);
        // tan of half of each triangle's solid angle is volume / abc and volume / acd.
        return 2 *
               (atan2(to_float(volume), to_float(abc)) + atan2(to_float(volume), to_float(acd)));
    }

    /// Point (x, y) of the rectangle; its direction is uniform over the solid angle for u uniform
    /// in [0,1)^2. Returned as fractions of the edges.
    RT_HD Vec2 sample(Vec2 u, float solid_angle) const {
        const Real one = 1, z2 = z0 * z0;
        // Cosines of the edges' normals with the z axis, and the two angles at x = x0 (eq. 4, 5).
        const Real ry0 = 1 / std::sqrt(z2 + y0 * y0), ry1 = 1 / std::sqrt(z2 + y1 * y1);
        const Real rx0 = 1 / std::sqrt(z2 + x0 * x0);
        const Real b0 = -y0 * ry0, b1 = y1 * ry1, b3 = -x0 * rx0;
        const Real cos2 = -b1 * b3, cos3 = -b3 * b0;
        const Real sin2 = -z0 * std::sqrt(z2 + x0 * x0 + y1 * y1) * rx0 * ry1;
        const Real sin3 = -z0 * std::sqrt(z2 + x0 * x0 + y0 * y0) * rx0 * ry0;
        // au = u S + 2 pi - g2 - g3: sine and cosine by addition.
        const SinCosOf<Real> part = sincos_unit<Real>(u.x * solid_angle);
        const Real cos_k = cos2 * cos3 - sin2 * sin3, sin_k = -(sin2 * cos3 + cos2 * sin3);
        const Real cos_au = part.cos * cos_k - part.sin * sin_k;
        const Real sin_au = part.sin * cos_k + part.cos * sin_k;
        // cu = sign(fu) / sqrt(fu^2 + b0^2) with fu = (cos_au b0 - b1) / sin_au, times sin_au.
        const Real numerator = cos_au * b0 - b1;
        const Real sine2 = sin_au * sin_au;
        const Real sum = numerator * numerator + b0 * b0 * sine2;
        const Real cu2 = sum > 0 ? (sine2 < sum ? sine2 / sum : one) : one;
        const Real rest = one - cu2;
        const bool positive = (numerator > 0) == (sin_au > 0);
        // No rest: x is infinite before the limit.
        const Real x = limit((positive ? -z0 : z0) * std::sqrt(cu2 / rest), x0, x1);
        const Real d2 = x * x + z2;
        const Real h0 = y0 / std::sqrt(d2 + y0 * y0), h1 = y1 / std::sqrt(d2 + y1 * y1);
        const Real share = u.y;
        const Real h = h0 + share * (h1 - h0);
        const Real h2 = h * h;
        const Real y = h2 < 1 ? limit(h * std::sqrt(d2 / (1 - h2)), y0, y1) : y1;
        return {to_float((x - x0) / (x1 - x0)), to_float((y - y0) / (y1 - y0))};
    }

    RT_HD static Real limit(Real v, Real low, Real high) {
        const Real raised = v < low ? low : v;
        return raised > high ? high : raised;
    }
};

/// A rectangle seen from a point as float sees it. See SphericalRectangle.
struct RectangleInFloat {
    RectangleView<float> view;
    float solid_angle; ///< steradians
    bool sound;        ///< whether float suffices

    RT_HD RectangleInFloat(Vec3 corner, Vec3 edge1, Vec3 edge2, Vec3 normal) {
        const float length1 = length(edge1), length2 = length(edge2);
        view.z0 = -std::fabs(dot(corner, normal));
        view.x0 = dot(corner, edge1) / length1;
        view.y0 = dot(corner, edge2) / length2;
        view.x1 = view.x0 + length1;
        view.y1 = view.y0 + length2;
        solid_angle = view.solid_angle(sound);
        sound &= -view.z0 > 0.01f * max(length1, length2);
    }
};

} // namespace detail

/// A rectangle seen from a point.
class SphericalRectangle {
  public:
    /// `corner`: relative to the point. `edge1`, `edge2`: at right angles. `normal`: unit, either
    /// side. The point must not lie in the plane of the rectangle.
    RT_HD SphericalRectangle(Vec3 corner, Vec3 edge1, Vec3 edge2, Vec3 normal)
        : near_(corner, edge1, edge2, normal), solid_angle_(near_.solid_angle) {
        if (!near_.sound) {
            exact_ = exact_view(corner, edge1, edge2);
            bool sound = true;
            solid_angle_ = exact_.solid_angle(sound);
        }
    }

    /// Steradians, in [0, 2 pi].
    [[nodiscard]] RT_HD float solid_angle() const { return solid_angle_; }

    /// Point (s, t) in [0,1]^2 of the rectangle: corner + s edge1 + t edge2. Its direction is
    /// uniform over the solid angle for u uniform in [0,1)^2.
    [[nodiscard]] RT_HD Vec2 sample(Vec2 u) const {
        return near_.sound ? near_.view.sample(u, solid_angle_) : exact_.sample(u, solid_angle_);
    }

  private:
    RT_HD static detail::RectangleView<double> exact_view(Vec3 corner, Vec3 edge1, Vec3 edge2) {
        const detail::Vec3d c(corner), e1(edge1), e2(edge2), n = cross(e1, e2);
        const double length1 = std::sqrt(dot(e1, e1)), length2 = std::sqrt(dot(e2, e2));
        detail::RectangleView<double> view;
        view.z0 = -std::fabs(dot(c, n)) / std::sqrt(dot(n, n));
        view.x0 = dot(c, e1) / length1;
        view.y0 = dot(c, e2) / length2;
        view.x1 = view.x0 + length1;
        view.y1 = view.y0 + length2;
        return view;
    }

    detail::RectangleInFloat near_;
    detail::RectangleView<double> exact_; ///< where float will not do
    float solid_angle_;
};

} // namespace plumb
