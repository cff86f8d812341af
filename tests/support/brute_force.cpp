#include "tests/support/brute_force.h"

#include <algorithm>
#include <cmath>

namespace plumb::test {
namespace {

using Real = long double;

struct Real3 {
    Real x, y, z;
};
Real3 widen(Vec3 v) {
    return {static_cast<Real>(v.x), static_cast<Real>(v.y), static_cast<Real>(v.z)};
}
Real3 operator-(Real3 a, Real3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Real3 operator*(Real s, Real3 a) { return {s * a.x, s * a.y, s * a.z}; }
Real dot(Real3 a, Real3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Real3 cross(Real3 a, Real3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

bool within(Real t, const Ray& ray) {
    return t > static_cast<Real>(ray.tmin) && t <= static_cast<Real>(ray.tmax);
}

/// Möller–Trumbore as in corrections.md.
std::optional<ExactHit> triangle_hit(const TriangleVertices& tri, const Ray& ray, double slack) {
    const Real3 origin = widen(ray.origin), d = widen(ray.direction), v0 = widen(tri.a);
    const Real3 e1 = widen(tri.b) - v0, e2 = widen(tri.c) - v0;
    const Real3 p = cross(d, e2);
    const Real det = dot(e1, p);
    if (det == 0)
        return std::nullopt;
    const Real3 s = origin - v0;
    const Real u = dot(s, p) / det;
    const Real3 q = cross(s, e1);
    const Real v = dot(d, q) / det;
    const Real t = dot(e2, q) / det;
    const Real edge = std::min({u, v, 1 - u - v});
    if (!(edge >= -static_cast<Real>(slack)) || !within(t, ray))
        return std::nullopt;
    ExactHit hit;
    hit.t = static_cast<double>(t);
    hit.u = static_cast<double>(u);
    hit.v = static_cast<double>(v);
    hit.edge = static_cast<double>(edge);
    return hit;
}

std::optional<ExactHit> sphere_hit(const Sphere& sphere, const Ray& ray, double slack) {
    const Real3 d = widen(ray.direction), f = widen(ray.origin) - widen(sphere.center);
    const Real r = static_cast<Real>(sphere.radius);
    const Real a = dot(d, d), b = dot(f, d);
    const Real3 passing = f - (b / a) * d; // from the centre to the nearest point of the line
    const Real distance = std::sqrt(dot(passing, passing));
    if (!(distance <= r * (1 + static_cast<Real>(slack))))
        return std::nullopt;
    const Real half = std::sqrt(std::max((r - distance) * (r + distance), Real{0}) / a);
    for (const Real t : {-b / a - half, -b / a + half})
        if (within(t, ray)) {
            ExactHit hit;
            hit.t = static_cast<double>(t);
            hit.edge = static_cast<double>((r - distance) / r);
            return hit;
        }
    return std::nullopt;
}

template <class Visit> void for_each_primitive(const GeometryView& view, const Visit& visit) {
    for (std::uint32_t g = 0; g < view.meshes.size(); ++g)
        for (std::uint32_t p = 0; p < view.meshes[g].triangles.size(); ++p)
            visit(g, p);
    for (std::uint32_t p = 0; p < view.spheres.size(); ++p)
        visit(view.sphere_geometry(), p);
}

} // namespace

std::optional<ExactHit> exact_hit(const GeometryView& view, std::uint32_t geometry,
                                  std::uint32_t primitive, const Ray& ray, double slack) {
    if (!is_traceable(view, geometry, primitive))
        return std::nullopt;
    std::optional<ExactHit> hit =
        view.is_sphere(geometry) ? sphere_hit(view.spheres[primitive], ray, slack)
                                 : triangle_hit(view.vertices(geometry, primitive), ray, slack);
    if (hit) {
        hit->geometry = geometry;
        hit->primitive = primitive;
    }
    return hit;
}

std::optional<ExactHit> brute_force_closest(const GeometryView& view, const Ray& ray) {
    std::optional<ExactHit> nearest;
    if (!is_valid(ray))
        return nearest;
    for_each_primitive(view, [&](std::uint32_t geometry, std::uint32_t primitive) {
        const auto hit = exact_hit(view, geometry, primitive, ray);
        if (hit && (!nearest || hit->t < nearest->t))
            nearest = hit;
    });
    return nearest;
}

bool brute_force_occluded(const GeometryView& view, const Ray& ray) {
    return brute_force_closest(view, ray).has_value();
}

} // namespace plumb::test
