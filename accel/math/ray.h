/// \file  Rays and hits, host and device: plain values, ids instead of pointers.
#pragma once

#include "accel/math/vec.h"

#include <cstdint>
#include <limits>

namespace plumb {

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr std::uint32_t invalid_id = 0xffffffffu;

/// Points origin + t * direction with tmin < t <= tmax (tmin exclusive, tmax inclusive).
/// The direction need not be a unit vector; t counts in its lengths.
struct Ray {
    Vec3 origin;
    float tmin = 0;
    Vec3 direction;
    float tmax = infinity;
};

/// Directions without a component of this size are too short: 1 / direction is infinite for those
/// below 2^-128.
inline constexpr float min_direction = std::numeric_limits<float>::min();

/// What every Intersector accepts: finite origin and direction of at most 1.8e18 a component, one
/// component of the direction at least min_direction, 0 <= tmin <= tmax. Any other ray is a miss.
[[nodiscard]] RT_HD inline bool is_valid(const Ray& ray) {
    // No test waits for another one: nearly all rays pass them all.
    const bool finite_origin = is_finite(ray.origin), finite_direction = is_finite(ray.direction);
    const float largest = max_component(abs(ray.direction));
    return finite_origin & finite_direction & (largest >= min_direction) & (ray.tmin >= 0) &
           (ray.tmin <= ray.tmax);
}

/// Closest intersection. On a triangle (a, b, c) the point is (1-u-v) a + u b + v c; on a sphere u
/// and v are 0.
struct Hit {
    float t = infinity;
    float u = 0, v = 0;
    std::uint32_t geometry = invalid_id;
    std::uint32_t primitive = invalid_id;
    std::uint32_t instance = invalid_id;

    [[nodiscard]] RT_HD bool valid() const { return geometry != invalid_id; }
};

} // namespace plumb
