/// \file  Ray-triangle tests that leak: oracles of failure, for tools/stability and its tests only.
///
/// T. Möller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", JGT 2(1), 1997, as it
/// is usually written; the watertight test of Woop, Benthin and Wald with the contraction that a
/// compiler applies by default to a*b - c*d.
#pragma once

#include "accel/triangle.h"

namespace plumb::stability {

/// A vector of any floating-point type.
template <class T> struct Vec {
    T x, y, z;

    explicit Vec(Vec3 v) : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)) {}
    Vec(T a, T b, T c) : x(a), y(b), z(c) {}
    friend Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend T dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    friend Vec cross(Vec a, Vec b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
};

/// Möller–Trumbore in T, both sides. `epsilon`: determinants up to it count as parallel, as in the
/// paper's code; 0: none but 0 itself.
template <class T> bool moeller_trumbore(const Ray& ray, Vec3 v0, Vec3 v1, Vec3 v2, T epsilon = 0) {
    const Vec<T> origin(ray.origin), d(ray.direction), a(v0), e1 = Vec<T>(v1) - a,
                                                              e2 = Vec<T>(v2) - a;
    const Vec<T> p = cross(d, e2);
    const T det = dot(e1, p);
    if (!(std::fabs(det) > epsilon))
        return false;
    const T inverse = 1 / det;
    const Vec<T> s = origin - a;
    const T u = dot(s, p) * inverse;
    if (!(u >= 0 && u <= 1))
        return false;
    const Vec<T> q = cross(s, e1);
    const T v = dot(d, q) * inverse;
    if (!(v >= 0 && u + v <= 1))
        return false;
    const T t = dot(e2, q) * inverse;
    return t > static_cast<T>(ray.tmin) && t <= static_cast<T>(ray.tmax);
}

/// The watertight test with a*b - c*d as fma(a, b, -(c*d)): only one product is rounded, so two
/// triangles disagree about their common edge.
inline bool watertight_contracted(const PreparedRay& ray, Vec3 v0, Vec3 v1, Vec3 v2) {
    const Vec3 a = detail::shear(ray, v0), b = detail::shear(ray, v1), c = detail::shear(ray, v2);
    const float u = std::fma(c.x, b.y, -(c.y * b.x));
    const float v = std::fma(a.x, c.y, -(a.y * c.x));
    const float w = std::fma(b.x, a.y, -(b.y * a.x));
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0))
        return false;
    const float det = u + v + w;
    if (det == 0)
        return false;
    const float t = (u * a.z + v * b.z + w * c.z) * ray.shear_z / det;
    return t > ray.tmin && t <= ray.tmax;
}

} // namespace plumb::stability
