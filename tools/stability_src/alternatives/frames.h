/// \file  Frames around a normal that break down: oracles of failure, for tools/stability and its
/// tests only.
#pragma once

#include "accel/math/vec.h"

namespace plumb::stability {

struct Basis {
    Vec3 s, t;
};

/// The cross product with one fixed axis: no direction is left where the normal is that axis.
inline Basis frame_from_axis(Vec3 n) {
    const Vec3 s = normalize(cross(Vec3{0, 0, 1}, n));
    return {s, cross(n, s)};
}

/// J. R. Frisvad, "Building an Orthonormal Basis from a 3D Unit Vector Without Normalization", JGT
/// 16(3), 2012: cancellation in 1 + n.z.
inline Basis frame_of_frisvad(Vec3 n) {
    if (n.z < -0.9999999f)
        return {{0, -1, 0}, {-1, 0, 0}};
    const float a = 1 / (1 + n.z), b = -n.x * n.y * a;
    return {{1 - n.x * n.x * a, b, -n.x}, {b, 1 - n.y * n.y * a, -n.y}};
}

/// The left axis of a camera that looks along `view`, for any angle to `up`: cancellation where
/// they are next to parallel, NaN where they are.
inline Vec3 left_without_refusal(Vec3 origin, Vec3 target, Vec3 up) {
    return normalize(cross(normalize(up), normalize(target - origin)));
}

} // namespace plumb::stability
