/// \file  plumb_stability: sweeps the axes of stress and writes stability.json.
#include "accel/embree/embree_scene.h"
#include "renderer/io/write_file.h"
#include "renderer/scene/error.h"
#include "tools/bench_src/cpu.h"
#include "tools/bench_src/progress.h"
#include "tools/exit_code.h"
#include "tools/stability_src/options.h"
#include "tools/stability_src/report.h"

#include <cstdio>
#include <fmt/format.h>
#include <unistd.h>

namespace plumb::stability {
namespace {

RunInfo info_of(const Options& options) {
    RunInfo info{options.command_line, bench::cpu_model(), embree_version(), {}, options.sweep};
#ifdef __clang__
    info.compiler = __VERSION__;
#else
    info.compiler = "GCC " __VERSION__;
#endif
    return info;
}

/// Makes the folder. Throws SceneError (output) where that or a file in it is not possible.
void prepare(const std::filesystem::path& folder, const std::filesystem::path& file) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw SceneError(ErrorKind::output, {folder.string()},
                         "cannot make this folder: " + error.message());
    check_writable(file);
}

int run(const Options& options) {
    const std::filesystem::path file = options.out / "stability.json";
    prepare(options.out, file);
    std::vector<AxisResult> results;
    {
        bench::Progress progress(options.quiet);
        std::string last;
        results = sweep(options.axes, options.sweep,
                        [&](std::size_t done, std::size_t all, const Axis& axis) {
                            if (axis.name != last)
                                progress.stage(axis.name);
                            last = axis.name;
                            progress.detail(fmt::format("{} of {} steps", done, all));
                        });
    }
    fmt::print("{}", table_text(results));
    std::fflush(stdout);
    atomic_write(file, to_json(info_of(options), results));
    const std::string wrong = violations_text(results);
    if (wrong.empty())
        return 0;
    const bool colour = isatty(STDERR_FILENO) == 1;
    fmt::print(stderr, "{}error: a method misses its limit\n{}{}", colour ? "\x1b[31m" : "", wrong,
               colour ? "\x1b[0m" : "");
    return 1;
}

} // namespace
} // namespace plumb::stability

int main(int argc, char** argv) {
    return plumb::exit_code_of([&] {
        const auto parsed = plumb::stability::parse_options(argc, argv);
        return parsed.exit_code ? *parsed.exit_code : plumb::stability::run(parsed.options);
    });
}
