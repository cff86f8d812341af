/// \file  Orthonormal frame around a unit normal, host and device.
///
/// T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017: no singular axis,
/// orthonormal to 5e-7 for every normal.
#pragma once

#include "accel/math/vec.h"

namespace plumb {

struct Frame {
    Vec3 s, t, n;

    RT_HD explicit Frame(Vec3 normal) : n(normal) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1 / (sign + n.z);
        const float b = n.x * n.y * a;
        s = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
        t = {b, sign + n.y * n.y * a, -n.y};
    }
    [[nodiscard]] RT_HD Vec3 to_local(Vec3 world) const {
        return {dot(world, s), dot(world, t), dot(world, n)};
    }
    [[nodiscard]] RT_HD Vec3 to_world(Vec3 local) const {
        return s * local.x + t * local.y + n * local.z;
    }
};

} // namespace plumb
