/// \file  The command line of plumb_gpu.
#pragma once

#include "cuda/ray_tracer.h"

#include <filesystem>
#include <optional>
#include <string>

namespace plumb::gpu {

struct Options {
    RaySide side = RaySide::device;
    bool images = true, rays = true;
    bool quick = false;         ///< small meshes, few samples
    int repetitions = 7;        ///< of each time; the median counts
    std::string only;           ///< not empty: scenes and meshes whose name begins so
    std::filesystem::path flat; ///< folder of flat scenes
    std::filesystem::path json; ///< empty: none
};

/// Options, or the exit code where there is nothing to do: 0 after --help, 2 for a mistake, which
/// is explained on stderr.
struct ParsedOptions {
    Options options;
    std::optional<int> exit_code;
};
[[nodiscard]] ParsedOptions parse_options(int argc, const char* const* argv);

} // namespace plumb::gpu
