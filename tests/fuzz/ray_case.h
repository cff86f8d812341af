/// \file  Geometry and rays out of the bytes that a fuzzer makes.
#pragma once

#include "tests/support/meshes.h"

#include <vector>

namespace plumb::fuzz {

/// What to build and to trace. Everything is allowed: NaN, degenerate triangles, invalid rays.
struct RayCase {
    test::TestGeometry geometry;
    std::vector<Ray> rays;
    bool with_embree = false; ///< it takes most of the time of a case
};

/// The bytes: flags (how coordinates are written, Embree), counts of vertices, triangles and
/// spheres, then vertices, triangles as indices, spheres, and rays until the bytes end. Coordinates
/// on a coarse grid make rays meet edges, corners and each other's planes exactly; raw floats reach
/// everything else. At most 64 vertices, 96 triangles, 4 spheres and 48 rays.
[[nodiscard]] RayCase ray_case_of(const std::uint8_t* data, std::size_t size);

} // namespace plumb::fuzz
