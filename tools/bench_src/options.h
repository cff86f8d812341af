/// \file  The command line of plumb_bench.
#pragma once

#include "tools/bench_src/catalogue.h"
#include "tools/bench_src/measure.h"
#include "tools/bench_src/validate_mesh.h"

#include <filesystem>
#include <optional>

namespace plumb::bench {

struct Options {
    std::vector<const CatalogueEntry*> meshes; ///< to generate
    std::vector<std::filesystem::path> files;  ///< to read
    MeasureOptions measure;
    bool all_naive = false; ///< naive was asked for: also on large meshes
    bool quick = false;
    bool quiet = false;
    std::filesystem::path replay;            ///< not empty: trace this file's rays, nothing else
    std::optional<ValidateOptions> validate; ///< compare instead of timing
    int threads = 1;                         ///< of the builds; 0: all cores
    std::filesystem::path json;              ///< empty: none
    std::optional<RaySide> cuda;             ///< the GPU's kernels too
    std::string command_line;
};

/// Options, or the exit code where there is nothing to do: 0 after --help, --version and --list, 2
/// for a mistake, which is explained on stderr.
struct ParsedOptions {
    Options options;
    std::optional<int> exit_code;
};
[[nodiscard]] ParsedOptions parse_options(int argc, const char* const* argv);

} // namespace plumb::bench
