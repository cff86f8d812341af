/// \file  plumb_warps: what the warps of a GPU would do with our kernels, counted on the CPU.

#include "accel/sah/build_compressed.h"
#include "accel/sah/build_sah.h"
#include "accel/sah/sah_intersector.h"
#include "renderer/integrate/render.h"
#include "renderer/io/load_scene.h"
#include "renderer/io/write_file.h"
#include "renderer/scene/scene_tables.h"
#include "tools/bench_src/catalogue.h"
#include "tools/exit_code.h"
#include "tools/warp_src/options.h"
#include "tools/warp_src/report.h"

#include <algorithm>

namespace plumb::warps {
namespace {

struct Trees {
    SahTree binary;
    CompressedTree wide;

    explicit Trees(const GeometryView& geometry)
        : binary(build_sah(geometry)), wide(build_compressed(geometry)) {}
    [[nodiscard]] TreeViews views() const { return {binary.view(), wide.view()}; }
};

void model_mesh(const bench::CatalogueEntry& entry, const Options& options, Report& report) {
    const bench::BenchMesh mesh = bench::generate(entry, options.quick);
    const MeshView mesh_view = mesh.mesh_view();
    const GeometryView geometry{{&mesh_view, 1}, {}};
    const auto sets = bench::make_ray_sets(mesh, SahIntersector(geometry, {}));
    const Trees trees(geometry);
    for (const bench::RaySet& set : sets) {
        std::vector<Question> rays;
        for (const Ray& ray : set.rays)
            rays.push_back({ray, set.any_hit()});
        for (const CudaTree tree : {CudaTree::binary, CudaTree::wide})
            for (const RayWay way : ray_ways)
                if (!rays.empty() && (way != RayWay::together || tree == CudaTree::binary))
                    report.add(mesh.name, model_cell(trees.views(), tree, set.kind, rays, way));
    }
}

void model_scene(const std::filesystem::path& file, const Options& options, Report& report) {
    const Scene scene = load_scene({file,
                                    {{"res", std::to_string(options.quick ? 64 : 256)},
                                     {"spp", std::to_string(options.quick ? 1 : 8)}},
                                    false});
    const SceneTables tables(scene);
    const Trees trees(tables.geometry());
    const auto paths = record_paths(make_job(scene, tables.view()), trees.views().binary);
    for (const CudaTree tree : {CudaTree::binary, CudaTree::wide})
        for (const PathWay way : path_ways)
            report.add(file.stem().string(), model_cell(trees.views(), tree, paths, way));
}

int run(const Options& options) {
    if (!options.json.empty())
        check_writable(options.json);
    Report report;
    for (const bench::CatalogueEntry& entry : bench::catalogue())
        if (std::ranges::find(options.meshes, entry.name) != options.meshes.end())
            model_mesh(entry, options, report);
    for (const std::filesystem::path& scene : options.scenes)
        model_scene(scene, options, report);
    if (!options.json.empty())
        atomic_write(options.json, report.json());
    return 0;
}

} // namespace
} // namespace plumb::warps

int main(int argc, char** argv) {
    const auto parsed = plumb::warps::parse_options(argc, argv);
    if (parsed.exit_code)
        return *parsed.exit_code;
    return plumb::exit_code_of([&] { return plumb::warps::run(parsed.options); });
}
