/// \file  --validate: a mesh's rays through two structures, every disagreement classified.
#pragma once

#include "accel/validate/validating_intersector.h"
#include "tools/bench_src/bench_mesh.h"
#include "tools/bench_src/progress.h"

namespace plumb::bench {

struct ValidateOptions {
    AccelKind other = AccelKind::embree; ///< what sah is compared with
    BuildOptions sah;                    ///< of our own tree
    std::size_t rays = 0; ///< of each mesh: its five sets, then random segments up to this many
};

/// Traces the mesh's rays as streams and one by one, half of the random segments each way.
[[nodiscard]] ValidationReport validate_mesh(const BenchMesh& mesh, const ValidateOptions& options,
                                             Progress& progress);

/// A line for the mesh: rays, how many of each class, and how many either got wrong.
[[nodiscard]] std::string validation_head();
[[nodiscard]] std::string validation_line(std::string_view mesh, const ValidationReport& report);

} // namespace plumb::bench
