/// \file  Ray-box tests that lose hits: oracles of failure, for tools/stability and its tests only.
#pragma once

#include "accel/math/bounds.h"

#include <algorithm>
#include <cmath>

namespace plumb::stability {

/// The form of most tutorials: std::min and std::max of both planes' distances. A NaN of 0 * inf
/// survives or not, depending on the side that it stands on.
inline bool slab_min_max(const Ray& ray, const Bounds& box) {
    float near = ray.tmin, far = ray.tmax;
    for (int axis = 0; axis < 3; ++axis) {
        const float inverse = 1 / ray.direction[axis];
        const float a = (box.lower[axis] - ray.origin[axis]) * inverse;
        const float b = (box.upper[axis] - ray.origin[axis]) * inverse;
        near = std::max(std::min(a, b), near);
        far = std::min(std::max(a, b), far);
    }
    return near <= far;
}

/// With fmin and fmax, which drop the NaN: the plane on which the ray runs is then taken for both.
inline bool slab_fmin_fmax(const Ray& ray, const Bounds& box) {
    float near = ray.tmin, far = ray.tmax;
    for (int axis = 0; axis < 3; ++axis) {
        const float inverse = 1 / ray.direction[axis];
        const float a = (box.lower[axis] - ray.origin[axis]) * inverse;
        const float b = (box.upper[axis] - ray.origin[axis]) * inverse;
        near = std::fmax(near, std::fmin(a, b));
        far = std::fmin(far, std::fmax(a, b));
    }
    return near <= far;
}

/// Near and far plane by the sign bit, NaN ignored: sound but for rounding, unless the far end is
/// multiplied by `padding` (1 + 4u is enough for the slab test alone).
inline bool slab_octant(const Ray& ray, const Bounds& box, float padding) {
    float near = ray.tmin, far = ray.tmax;
    for (int axis = 0; axis < 3; ++axis) {
        const bool negative = std::signbit(ray.direction[axis]);
        const float inverse = 1 / ray.direction[axis];
        const float enter = ((negative ? box.upper : box.lower)[axis] - ray.origin[axis]) * inverse;
        const float leave =
            ((negative ? box.lower : box.upper)[axis] - ray.origin[axis]) * inverse * padding;
        near = enter > near ? enter : near;
        far = leave < far ? leave : far;
    }
    return near <= far;
}

/// fma(plane, inverse, -origin * inverse) without a margin: the addend is rounded relative to
/// |origin * inverse|, and infinite where a component is zero: inf - inf for one of the planes.
inline bool slab_fused(const Ray& ray, const Bounds& box) {
    float near = ray.tmin, far = ray.tmax;
    for (int axis = 0; axis < 3; ++axis) {
        const float inverse = 1 / ray.direction[axis];
        const float addend = -ray.origin[axis] * inverse;
        const float a = std::fma(box.lower[axis], inverse, addend);
        const float b = std::fma(box.upper[axis], inverse, addend);
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    return near <= far;
}

} // namespace plumb::stability
