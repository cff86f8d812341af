/// \file  The GPU's kernel body, indexing, copies and batches, run on the host, give the CPU's
/// bits.

#include "cuda/host_grid.h"
#include "tests/support/box_scenes.h"
#include "tests/support/render_scene.h"

#include "accel/sah/build_compressed.h"
#include "accel/sah/build_sah.h"
#include "renderer/io/load_scene.h"
#include "renderer/scene/scene_tables.h"

#include <bit>
#include <gtest/gtest.h>

namespace plumb::test {
namespace {

Scene load_text(const std::string& xml) {
    Scene scene = load_xml(xml, {{"side", "21"}, {"spp", "5"}, {"sampler", "sobol"}});
    scene.path.max_depth = 6;
    scene.path.rr_depth = 2;
    return scene;
}

struct Outcome {
    Image image;
    RenderStats stats;
};

Outcome on_cpu(const Scene& scene, AccelKind kind, RenderOptions how = {},
               TriangleTest test = TriangleTest::watertight) {
    const SceneTables tables(scene);
    const auto intersector = make_intersector(kind, tables.geometry(), {test});
    how.threads = 1;
    Outcome result;
    result.image =
        render(make_job(scene, tables.view()), features_of(scene), *intersector, how, result.stats)
            .resolve();
    return result;
}

/// Blocks and chunks that do not divide 441 pixels.
constexpr HostGrid small_grid{32, 100, 250, 0};

Outcome on_grid(const Scene& scene, const CudaSettings& settings, const RenderOptions& how = {},
                const HostGrid& grid = small_grid, TriangleTest test = TriangleTest::watertight) {
    const SceneTables tables(scene);
    const SahTree binary = build_sah(tables.geometry());
    const CompressedTree wide = build_compressed(tables.geometry());
    TreeViews trees; // the other one is not there
    if (settings.tree == CudaTree::binary)
        trees.binary = binary.view();
    else
        trees.wide = wide.view();
    Outcome result;
    result.image = render_on_host_grid(make_job(scene, tables.view()), features_of(scene), trees,
                                       test, settings, grid, how, result.stats)
                       .resolve();
    return result;
}

class HostGridImage : public ::testing::TestWithParam<CudaSettings> {};
INSTANTIATE_TEST_SUITE_P(Every, HostGridImage, ::testing::ValuesIn(all_cuda_settings),
                         [](const auto& settings) {
                             return std::string(name_of(settings.param.tree)) + "_" +
                                    std::string(name_of(settings.param.schedule));
                         });

void expect_same_bits(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    ASSERT_EQ(a.size(), b.size());
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
    for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_TRUE(bits(a[i].r) == bits(b[i].r) && bits(a[i].g) == bits(b[i].g) &&
                    bits(a[i].b) == bits(b[i].b))
            << "pixel " << i;
}

void expect_same(const Outcome& a, const Outcome& b) {
    EXPECT_EQ(a.image.width, b.image.width);
    EXPECT_EQ(a.image.offset_x, b.image.offset_x);
    expect_same_bits(a.image.pixels, b.image.pixels);
    expect_same_bits(a.image.variance, b.image.variance);
    EXPECT_EQ(a.stats.rays.camera, b.stats.rays.camera);
    EXPECT_EQ(a.stats.rays.bounce, b.stats.rays.bounce);
    EXPECT_EQ(a.stats.rays.shadow, b.stats.rays.shadow);
    EXPECT_EQ(a.stats.samples, b.stats.samples);
}

TEST_P(HostGridImage, BoxKernelGivesTheBitsOfSahAndNaive) {
    const Scene scene = load_text(plain_box());
    const Outcome grid = on_grid(scene, GetParam());
    EXPECT_EQ(grid.stats.profile, "box");
    EXPECT_GT(grid.stats.rays.shadow, 0u);
    expect_same(grid, on_cpu(scene, AccelKind::sah));
    expect_same(grid, on_cpu(scene, AccelKind::naive));
}

TEST_P(HostGridImage, FullKernelGivesTheBitsOfSahAndNaive) {
    const Scene scene = load_text(rich_box());
    const Outcome grid = on_grid(scene, GetParam());
    EXPECT_EQ(grid.stats.profile, "full");
    expect_same(grid, on_cpu(scene, AccelKind::sah));
    expect_same(grid, on_cpu(scene, AccelKind::naive));
}

TEST_P(HostGridImage, FullKernelGivesTheBitsOfTheBoxKernel) {
    const Scene scene = load_text(plain_box());
    RenderOptions full;
    full.force_full_profile = true;
    const Outcome grid = on_grid(scene, GetParam(), full);
    EXPECT_EQ(grid.stats.profile, "full");
    expect_same(grid, on_grid(scene, GetParam()));
}

TEST_P(HostGridImage, MoellerTrumboreGivesTheBitsOfTheCpu) {
    constexpr TriangleTest test = TriangleTest::moeller_trumbore;
    const Scene scene = load_text(rich_box());
    expect_same(on_grid(scene, GetParam(), {}, small_grid, test),
                on_cpu(scene, AccelKind::sah, {}, test));
}

TEST_P(HostGridImage, VarianceHasTheBitsOfTheCpu) {
    RenderOptions how;
    how.variance = true;
    const Scene scene = load_text(plain_box());
    const Outcome grid = on_grid(scene, GetParam(), how);
    EXPECT_EQ(grid.image.variance.size(), grid.image.pixels.size());
    expect_same(grid, on_cpu(scene, AccelKind::sah, how));
}

TEST_P(HostGridImage, CropHasTheBitsOfTheCpu) {
    Scene scene = load_text(plain_box());
    scene.film.crop = {3, 5, 11, 7};
    expect_same(on_grid(scene, GetParam()), on_cpu(scene, AccelKind::sah));
}

TEST_P(HostGridImage, LimitsOfDepthAndNoRouletteHaveTheBitsOfTheCpu) {
    Scene scene = load_text(rich_box());
    for (const int depth : {1, 2, 3}) {
        scene.path.max_depth = depth;
        scene.path.roulette = depth == 2 ? RouletteKind::none : RouletteKind::constant;
        expect_same(on_grid(scene, GetParam()), on_cpu(scene, AccelKind::sah));
    }
}

TEST_P(HostGridImage, CutsIntoBlocksChunksAndWavesChangeNoBit) {
    const Scene scene = load_text(plain_box());
    const Outcome reference = on_cpu(scene, AccelKind::sah);
    for (const HostGrid grid :
         {HostGrid{1, 1u << 20, 1, 0}, HostGrid{128, 441, 5 * 441, 0}, HostGrid{33, 1, 1, 0},
          HostGrid{64, 440, 881, 0}, HostGrid{1024, 7, 1u << 14, 0}})
        expect_same(on_grid(scene, GetParam(), {}, grid), reference);
}

TEST_P(HostGridImage, TheOrderOfThreadsChangesNoBit) {
    const Scene scene = load_text(rich_box());
    const Outcome reference = on_cpu(scene, AccelKind::sah);
    for (const std::uint32_t shuffle : {1u, 2u, 77u})
        expect_same(on_grid(scene, GetParam(), {}, {32, 1u << 20, 1u << 14, shuffle}), reference);
}

TEST_P(HostGridImage, ProgressGrowsToOneWithAllRays) {
    const Scene scene = load_text(plain_box());
    std::vector<double> shares;
    std::uint64_t rays = 0;
    RenderOptions how;
    how.progress = [&](const ProgressState& now) {
        shares.push_back(now.done);
        EXPECT_GE(now.rays, rays);
        rays = now.rays;
    };
    const Outcome grid = on_grid(scene, GetParam(), how);
    ASSERT_GT(shares.size(), 4u); // 441 pixels in chunks of 100
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_DOUBLE_EQ(shares.back(), 1);
    EXPECT_EQ(rays, grid.stats.rays.total());
}

TEST_P(HostGridImage, CancelledItKeepsTheChunksThatAreDone) {
    const Scene scene = load_text(plain_box());
    std::atomic<bool> cancel{false};
    RenderOptions how;
    how.cancel = &cancel;
    how.progress = [&](const ProgressState& now) { cancel = now.done > 0.4; };
    const Outcome grid = on_grid(scene, GetParam(), how);
    const Outcome whole = on_cpu(scene, AccelKind::sah);
    EXPECT_LT(grid.stats.samples, whole.stats.samples);
    for (std::size_t i = 0; i < 100; ++i)
        EXPECT_EQ(grid.image.pixels[i], whole.image.pixels[i]);
    for (std::size_t i = 300; i < grid.image.pixels.size(); ++i)
        EXPECT_EQ(grid.image.pixels[i], Rgb{});
}

TEST(SampleStep, GrowsWhileLaunchesAreShortAndShrinksWhenTheyAreLong) {
    EXPECT_EQ(SampleStep(28).value(), 28u);
    SampleStep step(1);
    EXPECT_EQ(step.value(), 1u);
    step.measured(0.001);
    step.measured(0.001);
    EXPECT_EQ(step.value(), 4u);
    step.measured(0.1);
    EXPECT_EQ(step.value(), 4u);
    for (int i = 0; i < 5; ++i)
        step.measured(10);
    EXPECT_EQ(step.value(), 1u);
}

TEST(HostWaves, OnlyTheScheduleOfThatNameHasPersistentThreads) {
    const Scene scene = load_xml(plain_box(), {{"side", "8"}, {"spp", "2"}, {"sampler", "sobol"}});
    const SceneTables tables(scene);
    const CompressedTree wide = build_compressed(tables.geometry(), 1);
    const RenderJob job = make_job(scene, tables.view());
    const TreeViews trees{{}, wide.view()};
    HostBlock block(placed_size(job, trees));
    Arena arena = block.arena();
    const DeviceJob device = place(job, trees, arena);
    for (const CudaSchedule schedule : {CudaSchedule::wavefront, CudaSchedule::persistent}) {
        HostWaves<full_profile, TriangleTest::watertight, CudaTree::wide> waves(device, small_grid,
                                                                                schedule);
        waves.clear(64);
        EXPECT_GT(waves.run({0, 64, 0, 2}).bounce, 0u);
        std::uint64_t taken = 0;
        for (const WaveCounters& depth : waves.counters())
            taken += depth.taken;
        EXPECT_EQ(taken > 0, schedule == CudaSchedule::persistent);
    }
}

} // namespace
} // namespace plumb::test
