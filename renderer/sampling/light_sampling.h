/// \file  Sampling of one light as seen from a point, host and device.
///
/// Surface lights by solid angle (rectangles: Ureña et al. 2013; triangles: Arvo 1995; spheres: the
/// cone they subtend) or, for comparison, by area. Below `min_solid_angle` all points of a light
/// are about as far and as tilted, so area sampling is as good and keeps its accuracy.
#pragma once

#include "accel/math/frame.h"
#include "accel/triangle.h"
#include "renderer/sampling/spherical_rectangle.h"
#include "renderer/sampling/spherical_triangle.h"
#include "renderer/sampling/warp.h"
#include "renderer/scene/features.h"
#include "renderer/scene/light.h"

namespace plumb {

/// The receiving point: normal is unit, on the side that receives light.
struct Receiver {
    Vec3 position, normal;
};

struct LightSample {
    Vec3 wi;            ///< unit, towards the light
    Vec3 target;        ///< point on the light, moved off its surface towards the receiver
    float pdf = 0;      ///< per solid angle, without the choice of the light; 0: no light from here
    Rgb radiance;       ///< arriving, if nothing is in the way; divided by d^2 for point lights
    bool delta = false; ///< cannot be hit by a ray: no MIS
    bool infinite = false; ///< no target: test the ray without an end
};

/// Steradians below which a triangle or rectangle is sampled by area in any case.
inline constexpr float min_solid_angle = 5e-3f;

namespace detail {

/// Converts a uniform choice over `area` to solid angle; 0 behind the light or edge-on.
RT_HD inline float area_to_solid_angle(Vec3 to_light, Vec3 light_normal, float area) {
    const float d2 = dot(to_light, to_light);
    const float facing = -dot(light_normal, to_light);
    return facing > 0 && area > 0 ? d2 * std::sqrt(d2) / (facing * area) : 0;
}

/// Whether the receiver is in front of a flat light by more than rounding can account for. Points
/// of the light itself and of its plane get nothing from it; with a sign alone, half of a
/// luminous wall's own points would see that wall fill their hemisphere.
RT_HD inline bool in_front(const Light& light, Vec3 position) {
    const Vec3 error = rounding_bound(16) * (abs(light.origin) + abs(position));
    return dot(light.normal, position - light.origin) > dot(abs(light.normal), error);
}

RT_HD inline SphericalTriangle spherical_triangle(const Light& light, Vec3 position) {
    return {light.origin - position, light.edge1, light.edge2};
}

RT_HD inline SphericalRectangle spherical_rectangle(const Light& light, Vec3 position) {
    return {light.origin - position, light.edge1, light.edge2, light.normal};
}

/// How far off its plane a ray to a flat light must end, beside the rounding of the point.
RT_HD inline float slack_of(const Light& light) {
    return plane_slack(light.edge1, light.edge2, light.normal, 2 * light.area);
}

/// Fills in a sample at origin + s edge1 + t edge2, chosen uniformly over `solid_angle`, or over
/// the area if that is 0. `slack`: slack_of(light). Empty if the receiver is that very point.
RT_HD inline LightSample flat_sample(const Light& light, float slack, Vec3 position, Vec2 st,
                                     float solid_angle) {
    const Vec3 e1 = light.edge1 * st.x, e2 = light.edge2 * st.y;
    const Vec3 error = rounding_bound(7) * (abs(light.origin) + abs(e1) + abs(e2));
    const Vec3 point = light.origin + e1 + e2, to_light = point - position;
    LightSample s;
    s.wi = normalize(to_light);
    s.target = point + light.normal * (dot(abs(light.normal), error) + slack);
    s.radiance = light.emission;
    const float by_area = area_to_solid_angle(to_light, light.normal, light.area);
    const float pdf = solid_angle > 0 ? 1 / solid_angle : by_area;
    s.pdf = dot(to_light, to_light) > 0 ? pdf : 0; // or s.wi is no direction
    return s;
}

RT_HD inline LightSample sample_triangle_light(const Light& light, Vec3 position, Vec2 u,
                                               LightSampling method) {
    if (!in_front(light, position))
        return {};
    if (method == LightSampling::solid_angle) {
        const SphericalTriangle triangle = spherical_triangle(light, position);
        if (triangle.solid_angle() >= min_solid_angle)
            return flat_sample(light, slack_of(light), position, triangle.sample(u),
                               triangle.solid_angle());
    }
    return flat_sample(light, slack_of(light), position, sample_triangle(u), 0);
}

/// sample_rectangle_light as far as float goes: not where `sound` is false. No branches.
/// `slack`: slack_of(light).
RT_HD inline LightSample sample_rectangle_in_float(const Light& light, float slack, Vec3 position,
                                                   Vec2 u, LightSampling method, bool& sound) {
    const bool front = in_front(light, position);
    Vec2 st = u;
    float solid_angle = 0;
    sound = true;
    if (method == LightSampling::solid_angle) {
        const RectangleInFloat seen{light.origin - position, light.edge1, light.edge2,
                                    light.normal};
        const Vec2 chosen = seen.view.sample(u, seen.solid_angle);
        const bool wide = seen.solid_angle >= min_solid_angle;
        st = {wide ? chosen.x : u.x, wide ? chosen.y : u.y};
        solid_angle = wide ? seen.solid_angle : 0;
        sound = seen.sound | !front;
    }
    LightSample s = flat_sample(light, slack, position, st, solid_angle);
    s.pdf *= front ? 1.0f : 0.0f; // no select: it would split the loops that this is part of
    return s;
}

RT_HD inline LightSample sample_rectangle_light(const Light& light, Vec3 position, Vec2 u,
                                                LightSampling method) {
    if (!in_front(light, position))
        return {};
    bool sound = false;
    const LightSample s =
        sample_rectangle_in_float(light, slack_of(light), position, u, method, sound);
    if (sound)
        return s;
    const SphericalRectangle rectangle = spherical_rectangle(light, position);
    if (rectangle.solid_angle() >= min_solid_angle)
        return flat_sample(light, slack_of(light), position, rectangle.sample(u),
                           rectangle.solid_angle());
    return flat_sample(light, slack_of(light), position, u, 0);
}

/// Squared sine of the half angle of the cone around a sphere; > 1 inside.
RT_HD inline float sphere_sin2(const Light& light, Vec3 to_center) {
    return light.radius * light.radius / dot(to_center, to_center);
}

/// Whether the receiver is inside of a sphere light. A sphere that shines inwards is seen from its
/// own wall, whose points lie off it by rounding; they are inside.
RT_HD inline bool inside_sphere(const Light& light, Vec3 to_center) {
    const float sin2 = sphere_sin2(light, to_center);
    if (!light.inside_out)
        return !(sin2 < 1);
    const float reach = max_component(abs(light.origin)) / light.radius;
    return sin2 > 1 - rounding_bound(64) * (1 + reach);
}

/// Finishes a sample at the point center + radius * out; empty if the receiver is that very point.
RT_HD inline LightSample sphere_sample(const Light& light, Vec3 position, Vec3 out, float pdf) {
    const Vec3 arm = out * light.radius;
    const Vec3 error = rounding_bound(6) * (abs(light.origin) + abs(arm));
    const float push = dot(abs(out), error);
    const Vec3 to_light = light.origin + arm - position;
    if (!(dot(to_light, to_light) > 0))
        return {};
    LightSample s;
    s.wi = normalize(to_light);
    s.target = light.origin + arm + out * (light.inside_out ? -push : push);
    s.radiance = light.emission;
    s.pdf = pdf;
    return s;
}

RT_HD inline LightSample sample_sphere_light(const Light& light, Vec3 position, Vec2 u,
                                             LightSampling method) {
    const Vec3 to_center = light.origin - position;
    const bool inside = inside_sphere(light, to_center);
    if (inside != light.inside_out)
        return {};
    const Vec3 uniform = sample_uniform_sphere(u).direction;
    if (method == LightSampling::area) {
        const Vec3 normal = inside ? -uniform : uniform;
        const Vec3 to_light = to_center + uniform * light.radius;
        return sphere_sample(light, position, uniform,
                             area_to_solid_angle(to_light, normal, light.area));
    }
    if (inside) { // uniform in direction: far end of the chord from the receiver
        const float b = dot(to_center, uniform);
        const float c = dot(to_center, to_center) - light.radius * light.radius;
        const float t = b + std::sqrt(max(0.0f, b * b - c));
        LightSample s = sphere_sample(light, position, safe_normalize(uniform * t - to_center),
                                      0.5f * inv_two_pi);
        s.wi = uniform; // on the wall itself the chord may be shorter than its rounding
        return s;
    }
    const float extent = one_minus_cos(sphere_sin2(light, to_center));
    const DirectionSample cone = sample_cone(u, extent);
    // Angle at the centre between the receiver and the near crossing (Shirley, Wang 1996).
    const Vec3 c = cone.direction;
    const float sin2_theta = c.x * c.x + c.y * c.y;
    const float distance = length(to_center);
    const float t =
        distance * c.z -
        std::sqrt(max(0.0f, light.radius * light.radius - distance * distance * sin2_theta));
    const Frame frame(to_center / distance);
    const Vec3 wi = frame.to_world(c);
    return sphere_sample(light, position, safe_normalize(wi * t - to_center), cone.pdf);
}

RT_HD inline LightSample sample_point_light(const Light& light, Vec3 position) {
    const Vec3 to_light = light.origin - position;
    const float d2 = dot(to_light, to_light);
    if (!(d2 > 0))
        return {};
    LightSample s;
    s.wi = to_light / std::sqrt(d2);
    s.target = light.origin;
    s.radiance = light.emission * (1 / d2);
    s.pdf = 1;
    s.delta = true;
    return s;
}

/// Uniform over the receiver's hemisphere.
RT_HD inline LightSample sample_environment(const Light& light, const Receiver& receiver, Vec2 u) {
    const DirectionSample d = sample_uniform_hemisphere(u);
    LightSample s;
    s.wi = Frame(receiver.normal).to_world(d.direction);
    s.radiance = light.emission;
    s.pdf = d.pdf;
    s.infinite = true;
    return s;
}

} // namespace detail

/// A sample of one light for u uniform in [0,1)^2. `F` leaves out the kinds a scene lacks.
template <Features F>
RT_HD LightSample sample_light(const Light& light, const Receiver& receiver, Vec2 u,
                               LightSampling method) {
    if constexpr (F.triangle_lights)
        if (light.kind == LightKind::triangle)
            return detail::sample_triangle_light(light, receiver.position, u, method);
    if constexpr (F.spheres)
        if (light.kind == LightKind::sphere)
            return detail::sample_sphere_light(light, receiver.position, u, method);
    if constexpr (F.point_lights)
        if (light.kind == LightKind::point)
            return detail::sample_point_light(light, receiver.position);
    if constexpr (F.environment)
        if (light.kind == LightKind::environment)
            return detail::sample_environment(light, receiver, u);
    return detail::sample_rectangle_light(light, receiver.position, u, method);
}

/// Pdf per solid angle with which sample_light chooses the unit direction wi that meets the light
/// at `point` (unused for the environment). The front of the light must face the receiver.
template <Features F>
RT_HD float light_pdf(const Light& light, const Receiver& receiver, Vec3 wi, Vec3 point,
                      LightSampling method) {
    const Vec3 to_light = point - receiver.position;
    if constexpr (F.environment)
        if (light.kind == LightKind::environment)
            return dot(receiver.normal, wi) > 0 ? inv_two_pi : 0;
    if constexpr (F.spheres)
        if (light.kind == LightKind::sphere) {
            if (method == LightSampling::area) {
                const Vec3 out = safe_normalize(point - light.origin);
                return detail::area_to_solid_angle(to_light, light.inside_out ? -out : out,
                                                   light.area);
            }
            const Vec3 to_center = light.origin - receiver.position;
            return detail::inside_sphere(light, to_center)
                       ? 0.5f * inv_two_pi
                       : inv_two_pi / one_minus_cos(detail::sphere_sin2(light, to_center));
        }
    if (!detail::in_front(light, receiver.position))
        return 0;
    if (method == LightSampling::solid_angle) {
        float angle = 0;
        if (F.triangle_lights && light.kind == LightKind::triangle)
            angle = detail::spherical_triangle(light, receiver.position).solid_angle();
        else
            angle = detail::spherical_rectangle(light, receiver.position).solid_angle();
        if (angle >= min_solid_angle)
            return 1 / angle;
    }
    return detail::area_to_solid_angle(to_light, light.normal, light.area);
}

} // namespace plumb
