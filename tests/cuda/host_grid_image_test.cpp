/// \file  The GPU's kernel body, indexing, copies and batches, run on the host, give the CPU's
/// bits.

#include "tests/cuda/host_executor.h"
#include "tests/support/box_scenes.h"

#include "accel/sah/build_sah.h"
#include "renderer/io/load_scene.h"
#include "renderer/scene/scene_tables.h"

#include <bit>
#include <fstream>
#include <gtest/gtest.h>

namespace plumb::test {
namespace {

Scene load_text(const std::string& xml) {
    const std::filesystem::path file =
        std::filesystem::path(::testing::TempDir()) /
        (std::string("plumb_") +
         ::testing::UnitTest::GetInstance()->current_test_info()->test_suite_name() + "_" +
         ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".xml");
    std::ofstream(file, std::ios::binary) << xml;
    Scene scene = load_scene({file, {{"side", "21"}, {"spp", "5"}, {"sampler", "sobol"}}, false});
    std::filesystem::remove(file);
    scene.path.max_depth = 6;
    scene.path.rr_depth = 2;
    return scene;
}

struct Outcome {
    Image image;
    RenderStats stats;
};

/// How the host runs the grid.
struct GridSetup {
    std::uint32_t block_size = 32, chunk_pixels = 100;
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

template <Features F, TriangleTest Test = TriangleTest::watertight>
Outcome on_grid(const Scene& scene, const GridSetup& setup = {}, const RenderOptions& how = {}) {
    const SceneTables tables(scene);
    const SahTree tree = build_sah(tables.geometry());
    const RenderJob job = make_job(scene, tables.view());
    HostBlock block(placed_size(job, tree.view()));
    Arena arena = block.arena();
    DeviceJob device;
    device.job = job;
    device.job.scene = place(job.scene, arena);
    device.tree = place(tree.view(), arena);
    device.with_variance = how.variance;
    HostExecutor<F, Test> executor(device, setup.block_size);
    Outcome result;
    result.image =
        BatchRenderer(job, how, executor, result.stats).render(setup.chunk_pixels).resolve();
    return result;
}

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

TEST(HostGrid, BoxKernelGivesTheBitsOfSahAndNaive) {
    const Scene scene = load_text(plain_box());
    const Outcome grid = on_grid<box_profile>(scene);
    EXPECT_GT(grid.stats.rays.shadow, 0u);
    expect_same(grid, on_cpu(scene, AccelKind::sah));
    expect_same(grid, on_cpu(scene, AccelKind::naive));
}

TEST(HostGrid, FullKernelGivesTheBitsOfSahAndNaive) {
    const Scene scene = load_text(rich_box());
    const Outcome grid = on_grid<full_profile>(scene);
    expect_same(grid, on_cpu(scene, AccelKind::sah));
    expect_same(grid, on_cpu(scene, AccelKind::naive));
}

TEST(HostGrid, FullKernelGivesTheBitsOfTheBoxKernel) {
    const Scene scene = load_text(plain_box());
    expect_same(on_grid<full_profile>(scene), on_grid<box_profile>(scene));
}

TEST(HostGrid, MoellerTrumboreGivesTheBitsOfTheCpu) {
    constexpr TriangleTest test = TriangleTest::moeller_trumbore;
    const Scene scene = load_text(rich_box());
    expect_same(on_grid<full_profile, test>(scene), on_cpu(scene, AccelKind::sah, {}, test));
}

TEST(HostGrid, VarianceHasTheBitsOfTheCpu) {
    RenderOptions how;
    how.variance = true;
    const Scene scene = load_text(plain_box());
    const Outcome grid = on_grid<box_profile>(scene, {}, how);
    EXPECT_EQ(grid.image.variance.size(), grid.image.pixels.size());
    expect_same(grid, on_cpu(scene, AccelKind::sah, how));
}

TEST(HostGrid, CropHasTheBitsOfTheCpu) {
    Scene scene = load_text(plain_box());
    scene.film.crop = {3, 5, 11, 7};
    expect_same(on_grid<box_profile>(scene), on_cpu(scene, AccelKind::sah));
}

TEST(HostGrid, CutsIntoBlocksAndChunksChangeNoBit) {
    const Scene scene = load_text(plain_box());
    const Outcome reference = on_cpu(scene, AccelKind::sah);
    for (const GridSetup setup : {GridSetup{1, 1u << 20}, GridSetup{128, 441}, GridSetup{33, 1},
                                  GridSetup{64, 440}, GridSetup{1024, 7}})
        expect_same(on_grid<box_profile>(scene, setup), reference);
}

TEST(HostGrid, ProgressGrowsToOneWithAllRays) {
    const Scene scene = load_text(plain_box());
    std::vector<double> shares;
    std::uint64_t rays = 0;
    RenderOptions how;
    how.progress = [&](const ProgressState& now) {
        shares.push_back(now.done);
        EXPECT_GE(now.rays, rays);
        rays = now.rays;
    };
    const Outcome grid = on_grid<box_profile>(scene, {}, how);
    ASSERT_GT(shares.size(), 4u); // 441 pixels in chunks of 100
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_DOUBLE_EQ(shares.back(), 1);
    EXPECT_EQ(rays, grid.stats.rays.total());
}

TEST(HostGrid, CancelledItKeepsTheChunksThatAreDone) {
    const Scene scene = load_text(plain_box());
    std::atomic<bool> cancel{false};
    RenderOptions how;
    how.cancel = &cancel;
    how.progress = [&](const ProgressState& now) { cancel = now.done > 0.4; };
    const Outcome grid = on_grid<box_profile>(scene, {}, how);
    const Outcome whole = on_cpu(scene, AccelKind::sah);
    EXPECT_LT(grid.stats.samples, whole.stats.samples);
    for (std::size_t i = 0; i < 100; ++i)
        EXPECT_EQ(grid.image.pixels[i], whole.image.pixels[i]);
    for (std::size_t i = 300; i < grid.image.pixels.size(); ++i)
        EXPECT_EQ(grid.image.pixels[i], Rgb{});
}

TEST(SampleStep, GrowsWhileLaunchesAreShortAndShrinksWhenTheyAreLong) {
    SampleStep step;
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

} // namespace
} // namespace plumb::test
