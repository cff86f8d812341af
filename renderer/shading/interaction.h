/// \file  The point where a ray met a surface, with a bound of its error, host and device.
///
/// Hit points come from barycentrics (triangles) or are projected back onto the sphere; origins of
/// further rays are moved off the surface by the bound of the rounding error: M. Pharr, W. Jakob,
/// G. Humphreys, Physically Based Rendering, 4th ed., section 6.8.
#pragma once

#include "accel/math/frame.h"
#include "renderer/scene/scene_view.h"

#include <bit>

namespace plumb {

struct Interaction {
    Vec3 position;
    Vec3 error;     ///< bound of |position - true point|, each axis
    Vec3 geometric; ///< unit normal of the front
    Vec3 shading;   ///< unit shading normal, on the same side
};

namespace detail {

/// The next float up, or down. A NaN stays one: its bits are not the same on every machine.
RT_HD inline float next_float(float x, bool up) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
    const float next = std::bit_cast<float>(((x > 0) == up) ? bits + 1 : bits - 1);
    const float least = up ? 1e-45f : -1e-45f;
    return x != x ? x : x == 0 ? least : next;
}

/// Unit normal of a sliver whose cross product is too small: from scaled edges, or the direction
/// back along the ray if they are parallel.
RT_HD inline Vec3 sliver_normal(Vec3 edge1, Vec3 edge2, Vec3 ray_direction) {
    const Vec3 scaled = cross(safe_normalize(edge1), safe_normalize(edge2));
    return safe_normalize(dot(scaled, scaled) > 0 ? scaled : -ray_direction);
}

RT_HD inline Interaction interact_sphere(const SceneView& scene, const Hit& hit, const Ray& ray) {
    const Sphere& sphere = scene.geometry.spheres[hit.primitive];
    const Vec3 out = safe_normalize(ray.origin + ray.direction * hit.t - sphere.center);
    const Vec3 arm = out * sphere.radius;
    const bool flip = scene.surfaces[scene.surface_of(hit)].flip_normal;
    Interaction it;
    it.position = sphere.center + arm;
    it.error = rounding_bound(6) * (abs(sphere.center) + abs(arm) + abs(it.position));
    it.geometric = flip ? -out : out;
    it.shading = it.geometric;
    return it;
}

/// How far hit points are drawn towards the middle of their triangle, as a share of its size: more
/// than they are rounded by. A point on the very edge could lie on the wall that meets it there, or
/// behind it, and a ray from there would leave a closed room.
inline constexpr float inward_share = 0x1p-21f;

/// A flat triangle's point with barycentrics u, v. `sliver`: the normal is not one, take
/// sliver_normal.
RT_HD inline Interaction interact_triangle(const TriangleVertices& t, float u, float v,
                                           bool& sliver) {
    const float weight_b = u * (1 - 3 * inward_share) + inward_share;
    const float weight_c = v * (1 - 3 * inward_share) + inward_share;
    const Vec3 a = (1 - weight_b - weight_c) * t.a, b = weight_b * t.b, c = weight_c * t.c;
    Interaction it;
    it.position = a + b + c;
    const Vec3 edge1 = t.b - t.a, edge2 = t.c - t.a;
    const Vec3 n = cross(edge1, edge2);
    const float length2 = dot(n, n), cross_length = std::sqrt(length2);
    it.geometric = n / cross_length;
    const float slack = plane_slack(edge1, edge2, it.geometric, cross_length);
    it.error = rounding_bound(7) * (abs(a) + abs(b) + abs(c)) + Vec3{slack, slack, slack};
    it.shading = it.geometric;
    sliver = !(length2 > 1e-30f && length2 < infinity);
    return it;
}

/// The same for any triangle, hit by a ray of this direction.
RT_HD inline Interaction interact_triangle(const TriangleVertices& t, float u, float v,
                                           Vec3 ray_direction) {
    bool sliver = false;
    Interaction it = interact_triangle(t, u, v, sliver);
    if (sliver)
        it.geometric = it.shading = sliver_normal(t.b - t.a, t.c - t.a, ray_direction);
    return it;
}

} // namespace detail

/// Needs a valid hit of this ray. `Smooth`: interpolate shading normals where the mesh has them.
template <bool Spheres, bool Smooth>
RT_HD Interaction interact(const SceneView& scene, const Hit& hit, const Ray& ray) {
    if constexpr (Spheres)
        if (scene.geometry.is_sphere(hit.geometry))
            return detail::interact_sphere(scene, hit, ray);
    const TriangleVertices t = scene.geometry.vertices(hit.geometry, hit.primitive);
    Interaction it = detail::interact_triangle(t, hit.u, hit.v, ray.direction);
    if constexpr (Smooth) {
        const std::span<const Vec3> normals = scene.normals[hit.geometry];
        if (!normals.empty()) {
            const Triangle i = scene.geometry.meshes[hit.geometry].triangles[hit.primitive];
            const Vec3 smooth =
                (1 - hit.u - hit.v) * normals[i.a] + hit.u * normals[i.b] + hit.v * normals[i.c];
            if (dot(smooth, smooth) > 0)
                it.shading = normalize(smooth);
        }
    }
    return it;
}

/// Origin of a ray that leaves `position` on the side of the geometric normal where `direction`
/// points: off the surface by the error bound, rounded outwards.
RT_HD inline Vec3 offset_origin(Vec3 position, Vec3 error, Vec3 normal, Vec3 direction) {
    const float distance = dot(abs(normal), error);
    Vec3 offset = normal * distance;
    if (dot(direction, normal) < 0)
        offset = -offset;
    const auto moved = [](float x, float by) {
        const float sum = x + by;
        return by != 0 ? detail::next_float(sum, by > 0) : sum;
    };
    return {moved(position.x, offset.x), moved(position.y, offset.y), moved(position.z, offset.z)};
}

} // namespace plumb
