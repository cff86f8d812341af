/// \file  The measurement of one mesh: build, trace interleaved, check.
#pragma once

#include "tools/bench_src/progress.h"
#include "tools/bench_src/results.h"

namespace plumb::bench {

struct MeasureOptions {
    std::vector<Config> configs;
    std::vector<RayKind> kinds; ///< in the order to trace them
    int repetitions = 5;
    double seconds = 0.05; ///< least CPU time of one repetition of one configuration
    int builds = 3;        ///< of each structure; of meshes above a million triangles one
};

/// Builds every structure, makes the mesh's rays, and traces them with every configuration in turn,
/// `repetitions` times over: what slows the machine down for a while hits all of them alike. Before
/// that each configuration's answers are compared with those of naive (bit for bit, Embree's by
/// distance), and every timed pass must give the checksum of the answers that were compared.
///
/// Single-threaded but for the builds. Sets of rays that are empty are left out. Throws
/// std::runtime_error where a timed pass gives other answers, and what the structures throw.
[[nodiscard]] MeshResult measure(const BenchMesh& mesh, const MeasureOptions& options,
                                 Progress& progress);

} // namespace plumb::bench
