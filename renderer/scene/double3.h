/// \file  Three doubles: sums, areas and angles while meshes are loaded.
#pragma once

#include "accel/math/vec.h"

namespace plumb {

struct Double3 {
    double x = 0, y = 0, z = 0;
};

/// to - from, without overflow or rounding to float.
inline Double3 edge(Vec3 from, Vec3 to) {
    return {static_cast<double>(to.x) - static_cast<double>(from.x),
            static_cast<double>(to.y) - static_cast<double>(from.y),
            static_cast<double>(to.z) - static_cast<double>(from.z)};
}

inline double dot(Double3 a, Double3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

inline Double3 cross(Double3 a, Double3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

} // namespace plumb
