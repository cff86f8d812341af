/// \file  Light records that kernels sample, host and device.
#pragma once

#include "accel/math/ray.h"
#include "renderer/scene/rgb.h"

namespace plumb {

enum class LightKind : std::uint8_t { triangle, rectangle, sphere, point, environment };

/// One light. Triangle: origin + barycentrics over edge1, edge2. Rectangle: the parallelogram with
/// right angles origin + s edge1 + t edge2. Sphere: centre `origin`, `radius`. Point: `origin`.
/// Surface lights emit from their front only: the side of `normal`; spheres outside, or inside if
/// `inside_out`.
struct Light {
    LightKind kind = LightKind::point;
    bool inside_out = false; ///< spheres: the front is inside
    Rgb emission;            ///< radiance; W sr^-1 of a point light
    Vec3 origin, edge1, edge2;
    Vec3 normal; ///< unit
    float radius = 0;
    float area = 0;
    float probability = 0; ///< of being chosen
};

} // namespace plumb
