/// \file  The meshes that the project generates for its benchmark.
///
/// `detail` in (0, 1] scales the number of triangles; 1 is the size that is benchmarked. Positions
/// are plain float arithmetic with the project's own sine, so that every machine traces the same
/// bits.
#pragma once

#include "tools/bench_src/bench_mesh.h"

namespace plumb::bench {

/// A box room with two blocks and a lamp: 36 triangles at any detail.
[[nodiscard]] BenchMesh cornell(double detail);
/// A planet with mountains: closed, 5,197,088 triangles.
[[nodiscard]] BenchMesh terrain(double detail);
/// A smooth closed blob of 69,192 triangles, the size of the Stanford bunny.
[[nodiscard]] BenchMesh blob(double detail);
/// A rough closed blob of 1,598,472 triangles, as range scanners make them.
[[nodiscard]] BenchMesh scan(double detail);
/// A coarse stadium around a finely tessellated teapot: 48,818 triangles.
[[nodiscard]] BenchMesh teapot(double detail);
/// 60,000 long thin triangles at random.
[[nodiscard]] BenchMesh needles(double detail);
/// 20,000 curled strands, ribbons of 42 triangles each: 840,000.
[[nodiscard]] BenchMesh hair(double detail);
/// A colonnade with arches, vaults, stairs and tiles: 366,596 triangles.
[[nodiscard]] BenchMesh hall(double detail);

} // namespace plumb::bench
