/// \file  plumb_bench: Plumbline's trees and Embree on the same rays, timed and checked.
#include "accel/embree/embree_scene.h"
#include "accel/validate/run_replay.h"
#include "cuda/cuda_render.h"
#include "renderer/io/input_file.h"
#include "renderer/io/write_file.h"
#include "renderer/scene/error.h"
#include "tools/bench_src/cpu.h"
#include "tools/bench_src/options.h"
#include "tools/bench_src/report.h"
#include "tools/exit_code.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fmt/format.h>
#include <iostream>

namespace plumb::bench {
namespace {

RunInfo info_of(const Options& options) {
    RunInfo info;
    info.command_line = options.command_line;
    info.cpu = cpu_model();
    info.embree = embree_version();
#ifdef __clang__
    info.compiler = __VERSION__;
#else
    info.compiler = "GCC " __VERSION__;
#endif
    info.isas = supported_isas();
    info.threads = options.threads;
    info.repetitions = options.measure.repetitions;
    info.seconds = options.measure.seconds;
    info.quick = options.quick;
    return info;
}

void print(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
}

MeshResult measure_mesh(const BenchMesh& mesh, const Options& options) {
    MeasureOptions measured = options.measure;
    if (!options.all_naive && mesh.triangles.size() > naive_limit)
        std::erase_if(measured.configs, [](const Config& config) {
            return config.structure.accel == AccelKind::naive;
        });
    Progress progress(options.quiet);
    return measure(mesh, measured, progress);
}

/// The meshes that were asked for, one after the other.
template <class Use> void for_each_mesh(const Options& options, Use&& use) {
    for (const CatalogueEntry* entry : options.meshes)
        use(generate(*entry, options.quick));
    for (const std::filesystem::path& file : options.files) {
        std::vector<std::string> warnings;
        const BenchMesh mesh = load_mesh(file, warnings);
        for (const std::string& warning : warnings)
            fmt::print(stderr, "{}\n", warning);
        use(mesh);
    }
}

/// Traces a replay file's rays. Exit code 1 if anything is unexplained.
int replay(const std::filesystem::path& file) {
    try {
        const Replay rays = parse_replay(read_file(file, ErrorKind::mesh));
        return run_replay(rays, std::cout).unexplained > 0 ? 1 : 0;
    } catch (const ReplayError& error) {
        throw SceneError(ErrorKind::mesh, {file.string()}, error.what());
    }
}

int validate(const Options& options) {
    std::uint64_t unexplained = 0;
    print(validation_head());
    for_each_mesh(options, [&](const BenchMesh& mesh) {
        Progress progress(options.quiet);
        const ValidationReport report = validate_mesh(mesh, *options.validate, progress);
        unexplained += report.unexplained_count();
        print(validation_line(mesh.name, report));
    });
    print(fmt::format("unexplained: {}\n", unexplained));
    return unexplained > 0 ? 1 : 0;
}

int run(const Options& options) {
    if (!options.replay.empty())
        return replay(options.replay);
    if (options.validate)
        return validate(options);
    if (std::string why; options.cuda == RaySide::device && !cuda_available(&why))
        throw DeviceError(why);
    if (!options.json.empty())
        check_writable(options.json);
    const RunInfo info = info_of(options);
    print(head_text(info));
    std::vector<MeshResult> results;
    for_each_mesh(options, [&](const BenchMesh& mesh) {
        results.push_back(measure_mesh(mesh, options));
        print(mesh_text(results.back()));
    });
    print(summary_text(summary_of(results)));
    if (!options.json.empty())
        atomic_write(options.json, to_json(info, results));
    return 0;
}

} // namespace
} // namespace plumb::bench

int main(int argc, char** argv) {
    return plumb::exit_code_of([&] {
        const auto parsed = plumb::bench::parse_options(argc, argv);
        return parsed.exit_code ? *parsed.exit_code : plumb::bench::run(parsed.options);
    });
}
