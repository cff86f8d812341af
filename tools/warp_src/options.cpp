#include "tools/warp_src/options.h"

#include "tools/bench_src/catalogue.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace plumb::warps {

ParsedOptions parse_options(int argc, const char* const* argv) {
    ParsedOptions parsed;
    Options& o = parsed.options;
    CLI::App app{"What the warps of an H100 would do with the GPU's kernels, counted on the CPU: "
                 "lanes at work, instructions, bytes, and what would hold them up.",
                 "tools/warps"};
    std::vector<std::string> names;
    for (const bench::CatalogueEntry& entry : bench::catalogue())
        names.emplace_back(entry.name);
    app.add_option("scenes", o.scenes, "Scene files: whole paths")->check(CLI::ExistingFile);
    app.add_option("--meshes", o.meshes, "Rays of tools/bench on these meshes")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember(names));
    app.add_option("--json", o.json, "The numbers for programs");
    app.add_flag("--quick", o.quick, "Small meshes and images");
    try {
        app.parse(argc, argv);
        if (o.scenes.empty() && o.meshes.empty())
            throw CLI::ValidationError("scenes or --meshes", "one of them is needed");
    } catch (const CLI::Success& request) {
        parsed.exit_code = app.exit(request);
    } catch (const CLI::ParseError& error) {
        fmt::print(stderr, "error: {} (see --help)\n", error.what());
        parsed.exit_code = 2;
    }
    return parsed;
}

} // namespace plumb::warps
