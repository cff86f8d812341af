#include "tools/gpu_src/options.h"

#include <cstdio>
#include <string_view>

namespace plumb::gpu {
namespace {

constexpr const char* help =
    R"(Checks and times the kernels on a GPU, against flat scenes that tools/gpu --prepare wrote.

  plumb_gpu [OPTIONS] --flat FOLDER
  --flat FOLDER    flat scenes, each with the hash of the image that the CPU rendered
  --json FILE      the numbers for programs
  --images         the images only; --rays: the ray queries only
  --only NAME      scenes and meshes whose name begins with NAME
  --quick          small meshes, few samples
  --repetitions N  of each time [7]
  --host           the same kernels in a loop on the CPU
Exit codes: 0 all bits are right, 1 some are not, 2 usage, 6 no device, 7 it failed in the middle
(the JSON has what was done before), 70 a file or the program itself is wrong.
)";

int mistake(const std::string& what) {
    std::fprintf(stderr, "error: %s (see --help)\n", what.c_str());
    return 2;
}

} // namespace

ParsedOptions parse_options(int argc, const char* const* argv) {
    ParsedOptions parsed;
    Options& o = parsed.options;
    for (int i = 1; i < argc; ++i) {
        const std::string_view flag = argv[i];
        if (flag == "--help") {
            std::fputs(help, stdout);
            parsed.exit_code = 0;
            return parsed;
        }
        if (flag == "--host") {
            o.side = RaySide::host;
        } else if (flag == "--quick") {
            o.quick = true;
        } else if (flag == "--images") {
            o.rays = false;
        } else if (flag == "--rays") {
            o.images = false;
        } else if (flag == "--flat" || flag == "--json" || flag == "--only" ||
                   flag == "--repetitions") {
            if (++i == argc) {
                parsed.exit_code = mistake(std::string(flag) + " needs a value");
                return parsed;
            }
            const std::string value = argv[i];
            if (flag == "--flat")
                o.flat = value;
            else if (flag == "--json")
                o.json = value;
            else if (flag == "--only")
                o.only = value;
            else if (std::sscanf(value.c_str(), "%d", &o.repetitions) != 1 || o.repetitions < 1)
                parsed.exit_code = mistake("bad count (got '" + value + "', expected 1 or more)");
        } else {
            parsed.exit_code = mistake("unknown argument '" + std::string(flag) + "'");
        }
        if (parsed.exit_code)
            return parsed;
    }
    if (!o.images && !o.rays)
        parsed.exit_code = mistake("--images contradicts --rays");
    else if (o.images && o.flat.empty())
        parsed.exit_code = mistake("--flat is missing");
    return parsed;
}

} // namespace plumb::gpu
