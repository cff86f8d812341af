/// \file  Uniform sampling of the solid angle of a rectangle, host and device.
///
/// C. Ureña, M. Fajardo, A. King, "An Area-Preserving Parametrization for Spherical Rectangles",
/// EGSR 2013. The solid angle itself comes from the triple products of its two triangles (A. Van
/// Oosterom, J. Strackee 1983), which keeps its relative accuracy for small rectangles, where the
/// sum of four angles minus 2 pi cancels.
#pragma once

#include "accel/math/elementary.h"

namespace plumb {

/// A rectangle seen from a point, in the frame of its edges.
class SphericalRectangle {
  public:
    /// `corner`: relative to the point. `edge1`, `edge2`: at right angles. `normal`: unit, either
    /// side. The point must not lie in the plane of the rectangle.
    RT_HD SphericalRectangle(Vec3 corner, Vec3 edge1, Vec3 edge2, Vec3 normal)
        : length1_(length(edge1)), length2_(length(edge2)), x_axis_(edge1 / length1_),
          y_axis_(edge2 / length2_), z_axis_(normal) {
        z0_ = dot(corner, normal);
        if (z0_ > 0) { // z0 < 0 from here on
            z_axis_ = -z_axis_;
            z0_ = -z0_;
        }
        x0_ = dot(corner, x_axis_);
        y0_ = dot(corner, y_axis_);
        x1_ = x0_ + length1_;
        y1_ = y0_ + length2_;
        const Vec3 a{x0_, y0_, z0_}, b{x1_, y0_, z0_}, c{x1_, y1_, z0_}, d{x0_, y1_, z0_};
        const float la = length(a), lb = length(b), lc = length(c), ld = length(d);
        const float volume = -z0_ * length1_ * length2_;
        const float ac = dot(a, c);
        const float abc = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + ac * lb;
        const float acd = la * lc * ld + ac * ld + dot(c, d) * la + dot(d, a) * lc;
        // tan of half of each triangle's solid angle is volume / abc and volume / acd.
        solid_angle_ = 2 * (atan2(volume, abc) + atan2(volume, acd));
    }

    /// Steradians, in (0, 2 pi).
    [[nodiscard]] RT_HD float solid_angle() const { return solid_angle_; }

    /// Point (s, t) in [0,1]^2 of the rectangle: corner + s edge1 + t edge2. Its direction is
    /// uniform over the solid angle for u uniform in [0,1)^2.
    [[nodiscard]] RT_HD Vec2 sample(Vec2 u) const {
        const float z2 = z0_ * z0_;
        // Cosines of the edges' normals with the z axis, and the two angles at x = x0 (eq. 4, 5).
        const float ry0 = 1 / std::sqrt(z2 + y0_ * y0_), ry1 = 1 / std::sqrt(z2 + y1_ * y1_);
        const float rx0 = 1 / std::sqrt(z2 + x0_ * x0_);
        const float b0 = -y0_ * ry0, b1 = y1_ * ry1, b3 = -x0_ * rx0;
        const float cos2 = -b1 * b3, cos3 = -b3 * b0;
        const float sin2 = -z0_ * std::sqrt(z2 + x0_ * x0_ + y1_ * y1_) * rx0 * ry1;
        const float sin3 = -z0_ * std::sqrt(z2 + x0_ * x0_ + y0_ * y0_) * rx0 * ry0;
        // au = u S + 2 pi - g2 - g3: sine and cosine by addition.
        const SinCos part = sincos_radians(u.x * solid_angle_);
        const float cos_k = cos2 * cos3 - sin2 * sin3, sin_k = -(sin2 * cos3 + cos2 * sin3);
        const float cos_au = part.cos * cos_k - part.sin * sin_k;
        const float sin_au = part.sin * cos_k + part.cos * sin_k;
        // cu = sign(fu) / sqrt(fu^2 + b0^2) with fu = (cos_au b0 - b1) / sin_au, times sin_au.
        const float numerator = cos_au * b0 - b1;
        const float denominator2 = numerator * numerator + b0 * b0 * sin_au * sin_au;
        const float positive = (numerator > 0) == (sin_au > 0) ? 1.0f : -1.0f;
        const float cu2 = denominator2 > 0 ? min(1.0f, sin_au * sin_au / denominator2) : 1.0f;
        const float rest = 1 - cu2;
        const float x = rest > 0 ? clamp(-positive * std::sqrt(cu2 / rest) * z0_, x0_, x1_)
                                 : (positive > 0 ? x1_ : x0_);
        const float d2 = x * x + z2;
        const float h0 = y0_ / std::sqrt(d2 + y0_ * y0_), h1 = y1_ / std::sqrt(d2 + y1_ * y1_);
        const float h = h0 + u.y * (h1 - h0);
        const float h2 = h * h;
        const float y = h2 < 1 ? clamp(h * std::sqrt(d2 / (1 - h2)), y0_, y1_) : y1_;
        return {(x - x0_) / length1_, (y - y0_) / length2_};
    }

  private:
    float length1_, length2_;
    Vec3 x_axis_, y_axis_, z_axis_;
    float x0_, y0_, x1_, y1_, z0_;
    float solid_angle_;
};

} // namespace plumb
