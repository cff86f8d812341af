/// \file  The 8-wide tree one box at a time, for rays and scenes of extreme size.
#pragma once

#include "accel/sah/wide_bvh.h"

namespace plumb {

/// Closest hit by the scalar tests alone: any valid ray, coordinates up to max_coordinate.
[[nodiscard]] Hit closest_careful(const WideView& tree, const Ray& ray, TriangleTest test);

/// Whether any hit exists.
[[nodiscard]] bool occluded_careful(const WideView& tree, const Ray& ray, TriangleTest test);

} // namespace plumb
