/// \file  plumb_bench: Plumbline's trees and Embree on the same rays, timed and checked.
#include "accel/embree/embree_scene.h"
#include "renderer/io/write_file.h"
#include "renderer/scene/error.h"
#include "tools/bench_src/cpu.h"
#include "tools/bench_src/options.h"
#include "tools/bench_src/report.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fmt/format.h>
#include <new>

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

int run(const Options& options) {
    if (!options.json.empty())
        check_writable(options.json);
    const RunInfo info = info_of(options);
    print(head_text(info));
    std::vector<MeshResult> results;
    const auto add = [&](const BenchMesh& mesh) {
        results.push_back(measure_mesh(mesh, options));
        print(mesh_text(results.back()));
    };
    for (const CatalogueEntry* entry : options.meshes)
        add(generate(*entry, options.quick));
    for (const std::filesystem::path& file : options.files) {
        std::vector<std::string> warnings;
        const BenchMesh mesh = load_mesh(file, warnings);
        for (const std::string& warning : warnings)
            fmt::print(stderr, "{}\n", warning);
        add(mesh);
    }
    print(summary_text(summary_of(results)));
    if (!options.json.empty())
        atomic_write(options.json, to_json(info, results));
    return 0;
}

} // namespace
} // namespace plumb::bench

int main(int argc, char** argv) {
    constexpr int resources = 6, internal_error = 70;
    try {
        const auto parsed = plumb::bench::parse_options(argc, argv);
        return parsed.exit_code ? *parsed.exit_code : plumb::bench::run(parsed.options);
    } catch (const plumb::SceneError& error) {
        fmt::print(stderr, "{}\n", error.what());
        return error.exit_code();
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "error: out of memory\n");
        return resources;
    } catch (const std::exception& error) {
        fmt::print(stderr, "internal error: {}\n", error.what());
        return internal_error;
    }
}
