/// \file  Ray-triangle tests, single source for host and device.
///
/// Watertight: S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1),
/// 2013. Möller–Trumbore: T. Möller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle
/// Intersection", JGT 2(1), 1997. Compile without FMA contraction: `a*b - c*d` must round both
/// products, or two triangles disagree about their common edge.
#pragma once

#include "accel/prepared_ray.h"

namespace plumb {

enum class TriangleTest : std::uint8_t { watertight, moeller_trumbore };

/// Box of three points.
RT_HD inline Bounds vertex_bounds(Vec3 a, Vec3 b, Vec3 c) {
    return {min(a, min(b, c)), max(a, max(b, c))};
}

/// Box of a triangle, rounded outwards by what the shear of the watertight test can be wrong by:
/// each sheared vertex rounds five times, relative to its distance from the ray's origin. The part
/// that grows with the distance to the hit is in slab_padding; this is the part that grows with the
/// triangle. Without it a ray that starts near a large wall escapes beside the wall's edges: the
/// edge test accepts the triangle while the ray passes just outside the tight box.
RT_HD inline Bounds triangle_bounds(Vec3 a, Vec3 b, Vec3 c) {
    const Bounds tight = vertex_bounds(a, b, c);
    const float margin = 8 * unit_roundoff * max_component(tight.extent());
    const Vec3 unit{margin, margin, margin};
    const float ulp = 2 * unit_roundoff; // or the margin is lost in rounding far from zero
    return {tight.lower - (unit + ulp * abs(tight.lower)),
            tight.upper + (unit + ulp * abs(tight.upper))};
}

/// How far from a triangle's plane the tests below may still find a ray's origin in front of it:
/// `edge1` and `edge2` span the triangle, `cross_length` is their cross product's. Rays that leave
/// a surface must start farther off than this, or they hit it again: on a wall of size 2 that
/// passes through y = 0 the bound of the hit point alone is 1e-14, the error of t 1e-7.
///
/// The shear rounds 4 u of the distance to each vertex. The edge functions are weights of the
/// vertices' depths and round u of the product of two distances to the ray, which takes depth by a
/// share of that over the area: for a triangle of longest edge L at most 1 u L^3 / cross_length,
/// whatever the ray. The normal, and so the side on which a direction lies, rounds by as much
/// again. In slivers this is all that counts; it is followed up to L^2 / cross_length = 2^16.
///
/// t is moved into the box of the vertices, so an origin outside that box and ahead of it cannot be
/// in front of the plane either: thin triangles along an axis need no more than their thickness.
RT_HD inline float plane_slack(Vec3 edge1, Vec3 edge2, Vec3 normal, float cross_length) {
    const float size = max_component(abs(edge1)) + max_component(abs(edge2));
    const float stretch = size * size / (4 * cross_length); // 1 for a right angle of equal sides
    const float slack = 8 * unit_roundoff * size * clamp(stretch, 1, 16);
    const Vec3 edge3 = edge2 - edge1;
    const float longest2 = max(dot(edge1, edge1), max(dot(edge2, edge2), dot(edge3, edge3)));
    const float aspect = min(longest2 / cross_length, 0x1p16f);
    const float sliver = 2 * unit_roundoff * std::sqrt(longest2) * aspect;
    const Vec3 n = abs(normal), extent = abs(edge1) + abs(edge2) + Vec3{slack, slack, slack};
    // NaN where the normal is: min takes its second argument then.
    const float box = min(extent.x / n.x, min(extent.y / n.y, extent.z / n.z));
    return aspect > 16 ? max(slack, min(box, sliver)) : slack;
}

namespace detail {

/// Vertex relative to the ray origin, sheared so that the ray runs along +z. z is not yet scaled.
RT_HD inline Vec3 shear(const PreparedRay& ray, const Vec3& vertex) {
    const float z = component(vertex, ray.kz) - component(ray.slab.origin, ray.kz);
    return {component(vertex, ray.kx) - component(ray.slab.origin, ray.kx) - ray.shear_x * z,
            component(vertex, ray.ky) - component(ray.slab.origin, ray.ky) - ray.shear_y * z, z};
}

/// Twice the signed area spanned by two sheared vertices and the ray, in double.
/// Products of two floats are exact in double, so the sign is exact.
RT_HD inline float edge_function_exact(Vec3 p, Vec3 q) {
    return static_cast<float>(static_cast<double>(p.x) * static_cast<double>(q.y) -
                              static_cast<double>(p.y) * static_cast<double>(q.x));
}

/// 1 / (1 + s) for 0 <= s <= 2 within 1/26, by Chebyshev: 1 - (1 + s) p(s) is T3(s - 1) / T3(-2).
inline constexpr float projection_coefficient[3] = {25.0f / 26, -16.0f / 26, 4.0f / 26};

/// How much deeper than its z a point is nearest to the ray, for a point that barycentrics u, v, w,
/// not yet divided by their sum, place at (x, y) beside the ray: their rounding errors times the
/// triangle's size. z alone, as in the paper, is measured along an axis: on a needle across the ray
/// but not across that axis it is wrong by as much as the barycentrics are along the needle. 4 % of
/// that error may stay, so a quadratic does for the division by the direction's squared length.
RT_HD inline float slide(const PreparedRay& ray, float x, float y) {
    const float s = ray.shear_x * ray.shear_x + ray.shear_y * ray.shear_y;
    const float share =
        projection_coefficient[0] + s * (projection_coefficient[1] + s * projection_coefficient[2]);
    return (x * ray.shear_x + y * ray.shear_y) * share;
}

RT_HD inline bool watertight_candidate(const PreparedRay& ray, const Vec3& v0, const Vec3& v1,
                                       const Vec3& v2, PrimitiveHit& hit) {
    const Vec3 a = shear(ray, v0), b = shear(ray, v1), c = shear(ray, v2);
    float u = c.x * b.y - c.y * b.x;
    float v = a.x * c.y - a.y * c.x;
    float w = b.x * a.y - b.y * a.x;
    if (u == 0 || v == 0 || w == 0) {
        u = edge_function_exact(c, b);
        v = edge_function_exact(a, c);
        w = edge_function_exact(b, a);
    }
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0))
        return false;
    const float det = u + v + w;
    if (det == 0 || !(std::fabs(det) < infinity))
        return false;
    const float scale = 1 / det; // infinite for triangles smaller than 1e-19, which are missed
    const float weight_b = v * scale, weight_c = w * scale;
    float deeper = slide(ray, u * a.x + v * b.x + w * c.x, u * a.y + v * b.y + w * c.y) * scale;
    if (!(std::fabs(deeper) < infinity) && std::fabs(scale) < infinity)
        deeper = 0; // the sums overflowed: vertices farther than 1e12
    const float z = u * scale * a.z + weight_b * b.z + weight_c * c.z;
    hit = {(z + deeper) * ray.shear_z, weight_b, weight_c};
    return true;
}

RT_HD inline bool moeller_trumbore_candidate(const PreparedRay& ray, Vec3 v0, Vec3 v1, Vec3 v2,
                                             PrimitiveHit& hit) {
    const Vec3 e1 = v1 - v0, e2 = v2 - v0;
    const Vec3 p = cross(ray.direction, e2);
    const float det = dot(e1, p);
    if (det == 0)
        return false;
    const Vec3 s = ray.slab.origin - v0;
    const float u = dot(s, p) / det;
    if (!(u >= 0 && u <= 1))
        return false;
    const Vec3 q = cross(s, e1);
    const float v = dot(ray.direction, q) / det;
    if (!(v >= 0 && u + v <= 1))
        return false;
    hit = {dot(e2, q) / det, u, v};
    return true;
}

} // namespace detail

/// Intersects triangle (v0, v1, v2), both sides, for tmin < t <= tmax. Barycentrics: hit point
/// (1-u-v) v0 + u v1 + v v2. The watertight test never hits a triangle with two
/// equal vertices. Three different collinear ones it can hit, within rounding, which keeps the seam
/// between their neighbours closed; the normal there is zero.
template <TriangleTest Test = TriangleTest::watertight>
RT_HD inline bool intersect_triangle(const PreparedRay& ray, const Vec3& v0, const Vec3& v1,
                                     const Vec3& v2, float tmax, PrimitiveHit& hit) {
    // sah/isa/triangle_lanes.h repeats both paths in lanes: change both.
    if constexpr (Test == TriangleTest::watertight) {
        if (!detail::watertight_candidate(ray, v0, v1, v2, hit))
            return false;
    } else {
        if (!detail::moeller_trumbore_candidate(ray, v0, v1, v2, hit))
            return false;
    }
    const Interval tight = slab_interval(ray.slab, vertex_bounds(v0, v1, v2));
    if (tight.near <= tight.far) { // lies within the interval of triangle_bounds, which is larger
        hit.t = clamp_between(tight, hit.t);
        return is_between(ray.tmin, hit.t, tmax);
    }
    // It passes beside the box by a rounding error. Along an axis that it is parallel to it does so
    // everywhere; the others still say where.
    const Bounds wide = triangle_bounds(v0, v1, v2);
    Bounds across = vertex_bounds(v0, v1, v2);
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::fabs(ray.slab.inv_direction[axis]) < infinity)) {
            across.lower[axis] = wide.lower[axis];
            across.upper[axis] = wide.upper[axis];
        }
    hit.t = clamp_between(slab_interval(ray.slab, across), hit.t);
    return settle(ray, wide, tmax, hit);
}

} // namespace plumb
