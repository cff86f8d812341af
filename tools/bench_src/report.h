/// \file  The benchmark's results as text and as JSON.
#pragma once

#include "tools/bench_src/results.h"

#include <string>

namespace plumb::bench {

/// What the run was, for the head of either form.
struct RunInfo {
    std::string command_line, cpu, embree, compiler;
    std::vector<Isa> isas;
    int threads = 1; ///< of the builds; 0: all
    int repetitions = 0;
    double seconds = 0;
    bool quick = false;
};

[[nodiscard]] std::string head_text(const RunInfo& info);
/// Builds and cells of one mesh; at most 110 columns.
[[nodiscard]] std::string mesh_text(const MeshResult& mesh);
[[nodiscard]] std::string summary_text(const std::vector<SummaryRow>& summary);

/// One JSON object; tools/README.md describes its members.
[[nodiscard]] std::string to_json(const RunInfo& info, const std::vector<MeshResult>& meshes);

} // namespace plumb::bench
