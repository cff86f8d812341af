/// \file  Per-ray constants shared by every box and primitive test, host and device.
#pragma once

#include "accel/math/bounds.h"

namespace plumb {

/// A component chosen at run time: an indexed load on the host, selects on the device.
RT_HD inline float component(const Vec3& v, int axis) {
#ifdef __CUDA_ARCH__
    return v[axis];
#else
    return (&v.x)[axis];
#endif
}

/// A ray with what the slab test and the watertight triangle test (Woop, Benthin, Wald 2013,
/// section 3.1) need of it. Build once a ray; valid rays only.
struct PreparedRay {
    SlabRay slab;
    Vec3 direction;
    float tmin, tmax;
    int kx, ky, kz;                  ///< kz: the axis of the largest direction component
    float shear_x, shear_y, shear_z; ///< maps the direction to (0, 0, 1)

    RT_HD explicit PreparedRay(const Ray& ray)
        : slab(ray), direction(ray.direction), tmin(ray.tmin), tmax(ray.tmax) {
        const Vec3 a = abs(direction);
        kz = a.x > a.y ? (a.x > a.z ? 0 : 2) : (a.y > a.z ? 1 : 2);
        // The paper swaps kx and ky to keep the winding. Nothing is culled by winding here, and a
        // swap only negates U, V and W together, so it is left out.
        kx = kz == 2 ? 0 : kz + 1;
        ky = kx == 2 ? 0 : kx + 1;
        shear_z = 1 / direction[kz];
        shear_x = direction[kx] / direction[kz];
        shear_y = direction[ky] / direction[kz];
    }
};

/// A candidate hit of one primitive, before ids are attached.
struct PrimitiveHit {
    float t, u, v;
};

/// Whether a hit at t counts: tmin < t <= tmax, and finite.
RT_HD inline bool is_between(float tmin, float t, float tmax) {
    return t > tmin && t <= tmax && t < infinity;
}

/// Last step of every primitive test: t is moved into the interval over which the ray crosses the
/// primitive's own box, and the hit counts if that interval is not empty and tmin < t <= tmax.
///
/// This makes the answer independent of any tree: the slab test is monotone, so every box around
/// the primitive is crossed at or before t, whatever the rounding, and no order of traversal can
/// cull it. The move is within the rounding error of t.
RT_HD inline bool settle(const PreparedRay& ray, const Bounds& own, float tmax, PrimitiveHit& hit) {
    const Interval crossing = slab_interval(ray.slab, own);
    if (!(crossing.near <= crossing.far) || std::isnan(hit.t))
        return false;
    hit.t = clamp(hit.t, crossing.near, crossing.far);
    return is_between(ray.tmin, hit.t, tmax);
}

} // namespace plumb
