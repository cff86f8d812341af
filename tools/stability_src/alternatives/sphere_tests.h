/// \file  Ray-sphere tests in float: oracles of failure, for tools/stability and its tests only.
#pragma once

#include "accel/sphere.h"

#include <cmath>
#include <optional>

namespace plumb::stability {

/// The nearer of two roots beyond tmin.
inline std::optional<float> first_beyond(float tmin, float t0, float t1) {
    const float low = min(t0, t1), high = max(t0, t1);
    if (low > tmin)
        return low;
    if (high > tmin)
        return high;
    return {};
}

/// The school formula: b^2 - 4ac cancels where the sphere is small and far, or large and near.
inline std::optional<float> sphere_quadratic(const Ray& ray, const Sphere& sphere) {
    const Vec3 f = ray.origin - sphere.center;
    const float a = dot(ray.direction, ray.direction);
    const float b = 2 * dot(f, ray.direction);
    const float c = dot(f, f) - sphere.radius * sphere.radius;
    const float discriminant = b * b - 4 * a * c;
    if (!(discriminant >= 0))
        return {};
    const float root = std::sqrt(discriminant);
    return first_beyond(ray.tmin, (-b - root) / (2 * a), (-b + root) / (2 * a));
}

/// Hearn and Baker's discriminant in float: E. Haines et al., "Precision Improvements for
/// Ray/Sphere Intersection", Ray Tracing Gems, 2019, ch. 7. Better, not exact.
inline std::optional<float> sphere_hearn_baker(const Ray& ray, const Sphere& sphere) {
    const Vec3 f = ray.origin - sphere.center;
    const float a = dot(ray.direction, ray.direction);
    const float b = -dot(f, ray.direction);
    const Vec3 l = f + ray.direction * (b / a);
    const float discriminant = sphere.radius * sphere.radius - dot(l, l);
    if (!(discriminant >= 0))
        return {};
    const float q = b + std::copysign(std::sqrt(a * discriminant), b);
    const float c = dot(f, f) - sphere.radius * sphere.radius;
    return first_beyond(ray.tmin, c / q, q / a);
}

} // namespace plumb::stability
