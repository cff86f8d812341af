/// \file  Every scene of the project by the kernels of the GPU, on the host, with each tree and
/// schedule: the bits of naive and of the CPU's sah.

#include "cuda/host_grid.h"
#include "tests/cuda/project_scenes.h"
#include "tests/support/render_scene.h"

#include "accel/sah/build_compressed.h"
#include "accel/sah/build_sah.h"
#include "renderer/scene/scene_tables.h"

#include <gtest/gtest.h>

namespace plumb::test {
namespace {

class ScenesOnHostGrid : public ::testing::TestWithParam<std::filesystem::path> {};
INSTANTIATE_TEST_SUITE_P(Scenes, ScenesOnHostGrid, ::testing::ValuesIn(project_scenes()),
                         project_scene_name);

TEST_P(ScenesOnHostGrid, EveryTreeAndScheduleGivesTheBitsOfTheCpu) {
    Scene scene = load_project_scene(GetParam(), {{"res", "33"}, {"spp", "2"}});
    const SceneTables tables(scene);
    const SahTree binary = build_sah(tables.geometry());
    const CompressedTree wide = build_compressed(tables.geometry());
    const TreeViews trees{binary.view(), wide.view()};
    const Features needed = features_of(scene);
    const auto sah = make_intersector(AccelKind::sah, tables.geometry());
    const auto naive = make_intersector(AccelKind::naive, tables.geometry());
    struct Variant {
        SamplerKind sampler;
        Estimator estimator;
        bool full;
    };
    for (const Variant& variant : {Variant{SamplerKind::sobol, Estimator::mis, false},
                                   Variant{SamplerKind::independent, Estimator::light, true},
                                   Variant{SamplerKind::sobol, Estimator::bsdf, false}}) {
        scene.sampler.kind = variant.sampler;
        scene.path.estimator = variant.estimator;
        const RenderJob job = make_job(scene, tables.view());
        RenderOptions how;
        how.force_full_profile = variant.full;
        RenderStats stats;
        const Image cpu = render(job, needed, *sah, how, stats).resolve();
        EXPECT_EQ(bits_of(cpu), bits_of(render(job, needed, *naive, how, stats).resolve()));
        for (const CudaSettings& settings : all_cuda_settings) {
            RenderStats grid_stats;
            const Image grid = render_on_host_grid(job, needed, trees, TriangleTest::watertight,
                                                   settings, {}, how, grid_stats)
                                   .resolve();
            EXPECT_EQ(bits_of(cpu), bits_of(grid))
                << name_of(settings.tree) << name_of(settings.schedule);
        }
    }
}

} // namespace
} // namespace plumb::test
