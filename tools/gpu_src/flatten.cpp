/// \file  plumb_flatten: scenes and what the CPU renders of them, as files for machines without
/// readers.

#include "cuda/flat_scene.h"
#include "renderer/integrate/render.h"
#include "renderer/io/load_scene.h"
#include "renderer/scene/features.h"
#include "renderer/scene/image_hash.h"
#include "renderer/scene/scene_tables.h"
#include "tools/exit_code.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>

namespace plumb {
namespace {

struct Options {
    std::filesystem::path folder;
    std::vector<std::filesystem::path> scenes;
    int res = 96, spp = 4;
};

/// What the tests of the GPU vary: samplers, estimators, triangle tests, kernels.
struct Variant {
    const char* suffix;
    SamplerKind sampler;
    Estimator estimator;
    TriangleTest test;
    bool full_profile; ///< the kernel that can do everything, whatever the scene needs
};
constexpr Variant variants[] = {
    {"", SamplerKind::sobol, Estimator::mis, TriangleTest::watertight, false},
    {"-full", SamplerKind::sobol, Estimator::mis, TriangleTest::watertight, true},
    {"-light", SamplerKind::independent, Estimator::light, TriangleTest::watertight, false},
    {"-bsdf", SamplerKind::sobol, Estimator::bsdf, TriangleTest::moeller_trumbore, false}};

/// The reference is naive's: the plainest tree that there is.
FlatScene with_reference(std::string name, const RenderJob& job, const Features& needed,
                         TriangleTest test) {
    FlatScene flat = flatten(std::move(name), job, needed);
    flat.triangle_test = test;
    const auto naive = make_intersector(AccelKind::naive, job.scene.geometry, {test});
    RenderStats stats;
    flat.image_hash = hash_of(render(job, needed, *naive, {}, stats).resolve());
    flat.rays = stats.rays;
    return flat;
}

int run(const Options& options) {
    std::filesystem::create_directories(options.folder);
    for (const std::filesystem::path& file : options.scenes) {
        Scene scene = load_scene(
            {file,
             {{"res", std::to_string(options.res)}, {"spp", std::to_string(options.spp)}},
             false});
        const SceneTables tables(scene);
        for (const Variant& variant : variants) {
            scene.sampler.kind = variant.sampler;
            scene.path.estimator = variant.estimator;
            const std::string name = file.stem().string() + variant.suffix;
            const Features needed = variant.full_profile ? full_profile : features_of(scene);
            const FlatScene flat =
                with_reference(name, make_job(scene, tables.view()), needed, variant.test);
            write_flat(options.folder / (name + ".flat"), flat);
            fmt::print("{}: image {:016x}\n", name, flat.image_hash);
        }
    }
    return 0;
}

} // namespace
} // namespace plumb

int main(int argc, char** argv) {
    plumb::Options options;
    CLI::App app{"Writes scenes with what the CPU renders of them for plumb_gpu.", "plumb_flatten"};
    app.add_option("folder", options.folder, "Where the .flat files go")->required();
    app.add_option("scenes", options.scenes, "Scene files")->required();
    app.add_option("--res", options.res, "Their $res")->check(CLI::Range(1, 4096));
    app.add_option("--spp", options.spp, "Their $spp")->check(CLI::Range(1, 65536));
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& request) {
        return app.exit(request);
    } catch (const CLI::ParseError& error) {
        fmt::print(stderr, "error: {} (see --help)\n", error.what());
        return 2;
    }
    return plumb::exit_code_of([&] { return plumb::run(options); });
}
