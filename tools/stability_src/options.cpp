#include "tools/stability_src/options.h"

#include "renderer/io/nearest_name.h"
#include "renderer/unknown_argument.h"
#include "tools/bench_src/config.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>

namespace plumb::stability {
namespace {

constexpr const char* description =
    "Shows where methods fail: triangle and box tests, spheres, ray offsets, light sampling,\n"
    "roulette, warps, frames, sums, trees. Each axis of stress is swept with this project's\n"
    "methods and with alternatives that are known to fail. The renderer's defaults have to hold\n"
    "their limits over their ranges; the last lines and the exit code say so.";

constexpr const char* footer =
    "Examples:\n"
    "  stability --quick                        every axis, a few seconds\n"
    "  stability --axes offset,vertices         two axes\n"
    "  stability --axes 'slab-*' --out slabs    a pattern, into a folder\n"
    "Exit codes: 0 done, 1 a default misses its limit, 2 usage, 5 the folder cannot be written,\n"
    "6 resources, 70 internal.";

std::string join(int argc, const char* const* argv) {
    std::string line = "stability";
    for (int i = 1; i < argc; ++i)
        line += " " + std::string(argv[i]);
    return line;
}

/// The axes that a pattern matches, in their own order.
std::vector<Axis> chosen(const std::vector<std::string>& patterns) {
    std::vector<Axis> all = all_axes();
    if (patterns.empty())
        return all;
    std::vector<std::string_view> names;
    for (const Axis& axis : all)
        names.emplace_back(axis.name);
    std::vector<bool> taken(all.size());
    for (const std::string& pattern : patterns) {
        bool found = false;
        for (std::size_t i = 0; i < all.size(); ++i)
            if (bench::matches_glob(pattern, names[i]))
                taken[i] = found = true;
        if (!found)
            throw CLI::ValidationError(
                "--axes", fmt::format("no axis is called '{}'{}; --list shows the names", pattern,
                                      did_you_mean(pattern, names)));
    }
    std::vector<Axis> axes;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (taken[i])
            axes.push_back(std::move(all[i]));
    return axes;
}

void print_list() {
    std::string out;
    for (const Axis& axis : all_axes()) {
        out += fmt::format("{:<16} {} ({})\n", axis.name, axis.title, axis.unit);
        for (const Method& m : axis.methods)
            out += fmt::format("  {} {:<26} {}\n", m.is_default ? "+" : " ", m.name, m.what);
    }
    std::fputs((out + "Those with a + are the renderer's defaults.\n").c_str(), stdout);
}

} // namespace

ParsedOptions parse_options(int argc, const char* const* argv) {
    ParsedOptions parsed;
    Options& options = parsed.options;
    std::vector<std::string> patterns;
    bool list = false;
    CLI::App app(description, "stability");
    app.set_version_flag("--version", "Plumbline " PLUMB_VERSION);
    app.footer(footer);
    app.add_option("--out,-o", options.out, "Folder that receives everything [stability]")
        ->type_name("FOLDER");
    app.add_option("--axes", patterns, "Axes to sweep, comma-separated; * for any characters [all]")
        ->delimiter(',')
        ->type_name("NAME,...");
    app.add_option("--threads", options.sweep.threads, "0: all cores; the numbers are the same [1]")
        ->check(CLI::Range(0, 1024));
    app.add_option("--seed", options.sweep.seed, "Of the random trials [1]")
        ->check(CLI::NonNegativeNumber);
    app.add_flag("--quick", options.sweep.quick, "Fewer trials");
    app.add_flag("--list", list, "Print the axes and their methods and exit");
    app.add_flag("--quiet,-q", options.quiet, "No progress on stderr");
    app.allow_extras();
    try {
        app.parse(argc, argv);
        if (!app.remaining().empty())
            throw CLI::ExtrasError(app.remaining());
        options.axes = chosen(patterns);
    } catch (const CLI::Success& request) {
        parsed.exit_code = app.exit(request);
        return parsed;
    } catch (const CLI::ParseError& error) {
        const std::string what = app.remaining().empty() ? error.what() : unknown_argument(app);
        fmt::print(stderr, "error: {} (see --help)\n", what);
        parsed.exit_code = 2;
        return parsed;
    }
    if (list) {
        print_list();
        parsed.exit_code = 0;
    }
    options.command_line = join(argc, argv);
    return parsed;
}

} // namespace plumb::stability
