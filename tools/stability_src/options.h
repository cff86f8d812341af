/// \file  The command line of plumb_stability.
#pragma once

#include "tools/stability_src/sweep.h"

#include <filesystem>

namespace plumb::stability {

struct Options {
    std::vector<Axis> axes;
    SweepOptions sweep;
    std::filesystem::path out = "stability"; ///< folder
    bool quiet = false;
    std::string command_line;
};

/// Options, or the exit code where there is nothing to do: 0 after --help, --version and --list, 2
/// for a mistake, which is explained on stderr.
struct ParsedOptions {
    Options options;
    std::optional<int> exit_code;
};
[[nodiscard]] ParsedOptions parse_options(int argc, const char* const* argv);

} // namespace plumb::stability
