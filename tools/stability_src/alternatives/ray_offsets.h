/// \file  Ways to start a ray off a surface that meet it again or step over what is near: oracles
/// of failure, for tools/stability and its tests only.
#pragma once

#include "accel/math/ray.h"

#include <bit>

namespace plumb::stability {

/// A fixed tmin.
inline Ray leave_with_tmin(Vec3 position, Vec3 direction) {
    return {position, 1e-4f, direction, infinity};
}

/// A fixed step along the normal on the side of the direction.
inline Ray leave_along_normal(Vec3 position, Vec3 normal, Vec3 direction) {
    const Vec3 n = dot(normal, direction) < 0 ? -normal : normal;
    return {position + n * 1e-3f, 0, direction, infinity};
}

/// C. Wächter, N. Binder, "A Fast and Robust Method for Avoiding Self-Intersection", Ray Tracing
/// Gems, 2019, ch. 6: a step of some ulp in the integers of the floats.
inline Ray leave_by_integers(Vec3 position, Vec3 normal, Vec3 direction) {
    constexpr float near_origin = 1.0f / 32, float_scale = 1.0f / 65536, int_scale = 256;
    const Vec3 n = dot(normal, direction) < 0 ? -normal : normal;
    const auto moved = [&](float p, float along) {
        if (std::fabs(p) < near_origin)
            return p + float_scale * along;
        const auto step = static_cast<std::int32_t>(int_scale * along);
        const auto bits = std::bit_cast<std::int32_t>(p);
        return std::bit_cast<float>(bits + (p < 0 ? -step : step));
    };
    return {{moved(position.x, n.x), moved(position.y, n.y), moved(position.z, n.z)},
            0,
            direction,
            infinity};
}

} // namespace plumb::stability
