/// \file  Axis-aligned boxes and the slab test, host and device.
///
/// The slab test takes the near and the far plane by the sign bit of the direction and ignores the
/// NaN of 0 * inf (a ray that starts on a plane it runs along), so it loses no hit on a slab plane.
/// It is monotone: a box that contains another is hit over an interval that contains the other's.
#pragma once

#include "accel/math/ray.h"

namespace plumb {

struct Bounds {
    Vec3 lower{infinity, infinity, infinity};
    Vec3 upper{-infinity, -infinity, -infinity};

    [[nodiscard]] RT_HD bool empty() const {
        return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z);
    }
    [[nodiscard]] RT_HD Vec3 center() const { return lower * 0.5f + upper * 0.5f; }
    [[nodiscard]] RT_HD Vec3 extent() const { return upper - lower; }
    RT_HD void extend(Vec3 point) {
        lower = min(lower, point);
        upper = max(upper, point);
    }
    RT_HD void extend(const Bounds& other) {
        lower = min(lower, other.lower);
        upper = max(upper, other.upper);
    }
    [[nodiscard]] RT_HD bool contains(const Bounds& other) const {
        return lower.x <= other.lower.x && lower.y <= other.lower.y && lower.z <= other.lower.z &&
               upper.x >= other.upper.x && upper.y >= other.upper.y && upper.z >= other.upper.z;
    }
};

/// Surface area in double (float overflows above 1e19); 0 for an empty box.
[[nodiscard]] RT_HD inline double surface_area(const Bounds& b) {
    if (b.empty())
        return 0;
    const double x = static_cast<double>(b.upper.x) - static_cast<double>(b.lower.x);
    const double y = static_cast<double>(b.upper.y) - static_cast<double>(b.lower.y);
    const double z = static_cast<double>(b.upper.z) - static_cast<double>(b.lower.z);
    return 2 * (x * y + y * z + z * x);
}

/// Far planes are moved out by this factor. It covers the rounding of the slab test itself (3 u on
/// either plane) and of the shear in the watertight triangle test, with room to spare; tests show
/// that rays aimed at edges and vertices lose nothing.
inline constexpr float slab_padding = 1 + 32 * unit_roundoff;

/// The part of a ray that the slab test reads.
struct SlabRay {
    Vec3 origin;
    Vec3 inv_direction; ///< 1 / direction; infinite where a component is zero
    bool negative[3];   ///< sign bit of each direction component

    RT_HD explicit SlabRay(const Ray& ray)
        : origin(ray.origin), inv_direction{1 / ray.direction.x, 1 / ray.direction.y,
                                            1 / ray.direction.z},
          negative{std::signbit(ray.direction.x), std::signbit(ray.direction.y),
                   std::signbit(ray.direction.z)} {}
};

/// Interval of t between the planes of a box, the far end padded. Empty where near > far.
struct Interval {
    float near = 0, far = 0;
};

[[nodiscard]] RT_HD inline Interval slab_interval(const SlabRay& ray, const Bounds& box) {
    float near = -infinity, far = infinity;
    const auto clip = [&](bool negative, float lower, float upper, float origin, float inverse) {
        const float enter = ((negative ? upper : lower) - origin) * inverse;
        const float leave = ((negative ? lower : upper) - origin) * inverse;
        near = enter > near ? enter : near; // a NaN compares false: the other axes decide
        far = leave < far ? leave : far;
    };
    clip(ray.negative[0], box.lower.x, box.upper.x, ray.origin.x, ray.inv_direction.x);
    clip(ray.negative[1], box.lower.y, box.upper.y, ray.origin.y, ray.inv_direction.y);
    clip(ray.negative[2], box.lower.z, box.upper.z, ray.origin.z, ray.inv_direction.z);
    return {near, far > 0 ? far * slab_padding : far};
}

/// t moved between the two ends, whichever is the larger: of a box that the ray passes by a
/// rounding error only, they are inverted and nearly equal. A NaN stays one.
[[nodiscard]] RT_HD inline float clamp_between(Interval ends, float t) {
    const float low = min(ends.near, ends.far), high = max(ends.near, ends.far);
    return t < low ? low : t > high ? high : t;
}

/// Whether the box can hold a hit with tmin < t <= tmax.
[[nodiscard]] RT_HD inline bool overlaps(Interval box, float tmin, float tmax) {
    return box.near <= box.far && box.near <= tmax && box.far >= tmin;
}

} // namespace plumb
