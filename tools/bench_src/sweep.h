/// \file  Parts of generated buildings: boxes, bodies of revolution, tubes.
#pragma once

#include "tools/bench_src/bench_mesh.h"

#include <span>

namespace plumb::bench {

/// Closed axis-aligned box of 12 triangles.
void add_box(BenchMesh& mesh, Vec3 lower, Vec3 upper);

/// Body of revolution around the vertical axis through `base`: each point of the profile is a
/// radius and a height, `columns` vertices around. `flute` in [0, 1) carves that many of 24
/// grooves' depth into the radius: 0 is smooth.
void add_lathe(BenchMesh& mesh, Vec3 base, std::span<const Vec2> profile, std::uint32_t columns,
               float flute = 0);

/// Tube with one radius a point along a path in the plane z = path[0].z, `columns` vertices around.
void add_tube(BenchMesh& mesh, std::span<const Vec3> path, std::span<const float> radii,
              std::uint32_t columns);

/// `count` scaled down by sqrt(detail), at least `least`.
[[nodiscard]] std::uint32_t scaled_count(std::uint32_t count, double detail, std::uint32_t least);

} // namespace plumb::bench
