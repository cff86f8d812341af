/// \file  Lights with their surfaces in double, and closed forms of the irradiance they give.
#pragma once

#include "renderer/sampling/light_sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace plumb::test {

inline constexpr double pi_double = 3.14159265358979323846;

/// A vector in double.
struct Exact {
    double x = 0, y = 0, z = 0;

    Exact() = default;
    Exact(double a, double b, double c) : x(a), y(b), z(c) {}
    explicit Exact(Vec3 v)
        : x(static_cast<double>(v.x)), y(static_cast<double>(v.y)), z(static_cast<double>(v.z)) {}
    [[nodiscard]] Vec3 rounded() const {
        return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    }
};

inline Exact operator+(Exact a, Exact b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Exact operator-(Exact a, Exact b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Exact operator*(Exact a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(Exact a, Exact b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Exact cross(Exact a, Exact b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Exact a) { return std::sqrt(dot(a, a)); }
inline Exact normalize(Exact a) { return a * (1 / length(a)); }

inline Light flat_light(LightKind kind, Vec3 origin, Vec3 edge1, Vec3 edge2) {
    Light light;
    light.kind = kind;
    light.emission = {1, 1, 1};
    light.origin = origin;
    light.edge1 = edge1;
    light.edge2 = edge2;
    light.normal = normalize(cross(edge1, edge2));
    light.area = length(cross(edge1, edge2)) * (kind == LightKind::triangle ? 0.5f : 1.0f);
    light.probability = 1;
    return light;
}

inline Light sphere_light(Vec3 center, float radius, bool inside_out = false) {
    Light light;
    light.kind = LightKind::sphere;
    light.inside_out = inside_out;
    light.emission = {1, 1, 1};
    light.origin = center;
    light.radius = radius;
    light.area = 4 * pi * radius * radius;
    light.probability = 1;
    return light;
}

/// The part of a light that a receiver can see, as the image of [0,1]^2: by area, or for spheres
/// also by solid angle.
class LightSurface {
  public:
    struct Point {
        Exact position, normal; ///< normal: unit, on the emitting side
        double jacobian;        ///< area per area of [0,1]^2
    };

    LightSurface(const Light& light, Vec3 receiver, bool by_solid_angle = false)
        : light_(light), by_solid_angle_(by_solid_angle), receiver_(receiver),
          origin_(light.origin), edge1_(light.edge1), edge2_(light.edge2) {
        if (light.kind != LightKind::sphere) {
            normal_ = cross(edge1_, edge2_);
            area_ = length(normal_) * (light.kind == LightKind::triangle ? 0.5 : 1.0);
            normal_ = normalize(normal_);
            return;
        }
        radius_ = static_cast<double>(light.radius);
        const Exact out = receiver_ - origin_;
        const double d = length(out);
        axis_ = d > 0 ? out * (1 / d) : Exact{0, 0, 1};
        const Exact other = std::fabs(axis_.x) < 0.5 ? Exact{1, 0, 0} : Exact{0, 1, 0};
        side_ = normalize(cross(axis_, other));
        side2_ = cross(axis_, side_);
        // From outside the cap towards the receiver, from inside everything.
        span_ = light.inside_out ? 2 : 1 - radius_ / d;
        area_ = 2 * pi_double * radius_ * radius_ * span_;
        if (by_solid_angle_ && !light.inside_out) {
            const double sine = radius_ / d;
            span_ = sine * sine / (1 + std::sqrt(1 - sine * sine));
        }
    }

    [[nodiscard]] double area() const { return area_; }

    [[nodiscard]] Point at(double s, double t) const {
        switch (light_.kind) {
        case LightKind::rectangle: return {origin_ + edge1_ * s + edge2_ * t, normal_, area_};
        case LightKind::triangle: // the root map: uniform over the triangle
            return {origin_ + edge1_ * (std::sqrt(s) * (1 - t)) + edge2_ * (std::sqrt(s) * t),
                    normal_, area_};
        default: break;
        }
        const double z = 1 - s * span_, r = std::sqrt(std::max(0.0, 1 - z * z));
        const double phi = 2 * pi_double * t;
        if (by_solid_angle_) {
            const Exact d = axis_ * -z + side_ * (r * std::cos(phi)) + side2_ * (r * std::sin(phi));
            const Exact arm = d * distance_along(d) + receiver_ - origin_;
            const Exact n = normalize(arm) * (light_.inside_out ? -1.0 : 1.0);
            const double distance = distance_along(d), facing = -dot(n, d);
            return {origin_ + arm, n, 2 * pi_double * span_ * distance * distance / facing};
        }
        const Exact n = axis_ * z + side_ * (r * std::cos(phi)) + side2_ * (r * std::sin(phi));
        return {origin_ + n * radius_, n * (light_.inside_out ? -1.0 : 1.0), area_};
    }

    /// (s, t) of the point that a direction meets; may lie a rounding error outside of [0,1]^2.
    [[nodiscard]] std::array<double, 2> seen_along(Vec3 direction) const {
        const Exact d(direction);
        if (light_.kind != LightKind::sphere) {
            const Exact p = receiver_ + d * (dot(origin_ - receiver_, normal_) / dot(d, normal_));
            const Exact local = p - origin_;
            // Solves s edge1 + t edge2 = local, whatever the angle between the edges.
            const double ee = dot(edge1_, edge1_), ef = dot(edge1_, edge2_);
            const double ff = dot(edge2_, edge2_), det = ee * ff - ef * ef;
            const double le = dot(local, edge1_), lf = dot(local, edge2_);
            const double s = (le * ff - lf * ef) / det, t = (lf * ee - le * ef) / det;
            if (light_.kind == LightKind::rectangle)
                return {s, t};
            return {(s + t) * (s + t), s + t > 0 ? t / (s + t) : 0};
        }
        if (by_solid_angle_) {
            const double phi = turns(d);
            const Exact u = normalize(d);
            const double x = dot(u, side_), y = dot(u, side2_), cosine = -dot(u, axis_);
            const double drop = cosine > 0 ? (x * x + y * y) / (1 + cosine) : 1 - cosine;
            return {drop / span_, phi};
        }
        const Exact n = normalize(receiver_ - origin_ + d * distance_along(d));
        return {(1 - dot(n, axis_)) / span_, turns(n)};
    }

  private:
    /// Of the emitting side of a sphere, in lengths of d.
    [[nodiscard]] double distance_along(Exact d) const {
        const Exact f = receiver_ - origin_;
        const double a = dot(d, d), b = -dot(f, d);
        const Exact closest = f + d * (b / a);
        const double half = std::sqrt(std::max(0.0, radius_ * radius_ - dot(closest, closest)) / a);
        return b / a + (light_.inside_out ? half : -half);
    }
    /// Azimuth about the axis, in [0, 1).
    [[nodiscard]] double turns(Exact v) const {
        const double phi = std::atan2(dot(v, side2_), dot(v, side_)) / (2 * pi_double);
        return phi < 0 ? phi + 1 : phi;
    }

    Light light_;
    bool by_solid_angle_;
    Exact receiver_, origin_, edge1_, edge2_, normal_;
    double area_ = 0;
    Exact axis_, side_, side2_;
    double radius_ = 0, span_ = 0;
};

/// Irradiance that a polygon of radiance 1 gives to `point` with the unit `normal`, by Lambert's
/// formula (1/2) sum of Theta_i (Gamma_i . n), after clipping to the horizon.
inline double polygon_irradiance(const std::vector<Exact>& corners, Exact point, Exact normal) {
    std::vector<Exact> above;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Exact a = corners[i] - point, b = corners[(i + 1) % corners.size()] - point;
        const double ha = dot(a, normal), hb = dot(b, normal);
        if (ha >= 0)
            above.push_back(a);
        if ((ha < 0) != (hb < 0))
            above.push_back(a + (b - a) * (ha / (ha - hb)));
    }
    double sum = 0;
    for (std::size_t i = 0; i < above.size(); ++i) {
        const Exact a = normalize(above[i]), b = normalize(above[(i + 1) % above.size()]);
        const Exact n = cross(a, b);
        const double sine = length(n);
        if (sine > 0)
            sum += std::atan2(sine, dot(a, b)) * dot(n, normal) / sine;
    }
    return std::fabs(sum) / 2;
}

inline std::vector<Exact> corners_of(const Light& light) {
    const Exact o(light.origin), a(light.edge1), b(light.edge2);
    if (light.kind == LightKind::triangle)
        return {o, o + a, o + b};
    return {o, o + a, o + a + b, o + b};
}

/// A light and a point that it shines on.
struct LightCase {
    std::string name;
    Light light;
    Vec3 receiver;
    /// Cells a side for the chi² test; points a cell side for the integral of the pdf.
    int cells = 12, points = 12;
};

/// Lights in front of their receivers: none a unit square, none at distance 1, many tilted, at both
/// sides of min_solid_angle (for the first rectangle, of area 5, at a distance of 31.6).
inline std::vector<LightCase> light_cases() {
    const Light wide = flat_light(LightKind::rectangle, {-0.75f, -0.5f, 2.5f}, {0, 2, 0},
                                  {2.5f, 0, 0}); // facing down
    const Light tilted =
        flat_light(LightKind::rectangle, {1, -0.3f, 0.2f}, {0.6f, 0, 0.6f}, {0.3f, 0.9f, -0.3f});
    const Light strip =
        flat_light(LightKind::rectangle, {-40, 0.5f, 0.3f}, {0, 0.02f, 0}, {80, 0, 0});
    const Light far_away =
        flat_light(LightKind::rectangle, {10000, 20000, -30000}, {0, 200, 0}, {125, 0, 0});
    const Light triangle = flat_light(LightKind::triangle, {-0.6f, -0.9f, 1.7f}, {0.4f, 2.1f, 0.3f},
                                      {1.9f, 0.2f, -0.6f});
    const Light sliver =
        flat_light(LightKind::triangle, {-1, 0.1f, 0.5f}, {0, 0.01f, 0}, {3, 0.2f, 0.1f});
    const Light needle =
        flat_light(LightKind::triangle, {-1, 0.1f, 0.5f}, {3, 0.21f, 0.1f}, {3, 0.2f, 0.1f});
    const Light big = flat_light(LightKind::triangle, {-50, -40, 2}, {0, 90, 0}, {110, 0, 0});
    const Light ball = sphere_light({0.4f, -0.3f, 1.2f}, 0.35f);
    const Light cavity = sphere_light({0.4f, -0.3f, 1.2f}, 0.35f, true);
    const auto beside = [&](float ratio) {
        return ball.origin - normalize(Vec3{1, 2, 2}) * (ratio * ball.radius);
    };
    const auto inside = [&](float ratio) {
        return cavity.origin + normalize(Vec3{2, -1, 2}) * (ratio * cavity.radius);
    };
    return {
        {"rectangle_parallel", wide, {0, 0, 0}},
        {"rectangle_beside", wide, {3, 2, 0.5f}},
        {"rectangle_above_the_threshold", wide, {0.5f, 0.5f, -28.5f}},
        {"rectangle_below_the_threshold", wide, {0.5f, 0.5f, -29.8f}},
        {"rectangle_far", wide, {30, -100, -300}},
        {"rectangle_at_height_0_1", wide, {0.3f, 0.2f, 2.4f}, 16, 16},
        {"rectangle_at_height_0_01", wide, {0.3f, 0.2f, 2.49f}, 40, 12},
        {"rectangle_grazing", wide, {4, 0.2f, 2.45f}},
        {"rectangle_under_its_corner", wide, {-0.75f, -0.5f, 2.0f}},
        {"rectangle_under_its_edge", wide, {-0.75f, 0.5f, 2.0f}},
        {"rectangle_under_its_middle", wide, {0.5f, 0.5f, 1.5f}},
        {"rectangle_tilted", tilted, {0, 0.1f, 1.9f}},
        {"rectangle_strip", strip, {1, 0, 0}, 20, 30},
        {"rectangle_at_a_large_offset", far_away, {10050, 20070, -30050}},
        {"triangle", triangle, {0.1f, 0.2f, 0}},
        {"triangle_beside", triangle, {2, -1.5f, 0.3f}},
        {"triangle_above_the_threshold", triangle, {0.2f, 0.1f, -18}},
        {"triangle_below_the_threshold", triangle, {0.2f, 0.1f, -20}},
        {"triangle_far", triangle, {30, -40, -300}},
        {"triangle_close", triangle, {0.1f, 0.1f, 1.65f}, 20, 16},
        {"triangle_sliver_by_its_short_edge", sliver, {-1, 0.2f, 0.3f}},
        {"triangle_sliver_by_its_long_edges", needle, {-1, 0.2f, 0.3f}},
        {"triangle_that_fills_the_sky", big, {0, 0, 0}, 40, 12},
        {"sphere_at_1_01_radii", ball, beside(1.01f)},
        {"sphere_at_2_radii", ball, beside(2)},
        {"sphere_at_10_radii", ball, beside(10)},
        {"sphere_at_1000_radii", ball, beside(1000)},
        {"sphere_at_100000_radii", ball, beside(100000)},
        {"cavity_from_its_centre", cavity, cavity.origin},
        {"cavity_off_its_centre", cavity, inside(0.5f)},
        {"cavity_near_its_wall", cavity, inside(0.97f), 24, 16},
    };
}

} // namespace plumb::test
