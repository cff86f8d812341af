/// \file  The command line of plumb_warps.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumb::warps {

struct Options {
    std::vector<std::string> meshes; ///< names of the catalogue of tools/bench
    std::vector<std::filesystem::path> scenes;
    std::filesystem::path json; ///< empty: none
    bool quick = false;
};

/// Options, or the exit code where there is nothing to do: 0 after --help, 2 for a mistake, which
/// is explained on stderr.
struct ParsedOptions {
    Options options;
    std::optional<int> exit_code;
};
[[nodiscard]] ParsedOptions parse_options(int argc, const char* const* argv);

} // namespace plumb::warps
