/// \file  The model of a GPU's warps: what must hold however lanes wait for one another.

#include "tools/warp_src/path_model.h"
#include "tools/warp_src/ray_model.h"

#include "accel/sah/build_compressed.h"
#include "accel/sah/build_sah.h"
#include "renderer/integrate/render.h"
#include "renderer/scene/scene_tables.h"
#include "tests/support/box_scenes.h"
#include "tests/support/random.h"
#include "tests/support/render_scene.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>

namespace plumb::warps::test {
namespace {

using plumb::test::Random;

TEST(WarpL1, HoldsTheSectorsThatWereTouchedLast) {
    L1Cache l1(16 * 128); // one set of sixteen lines
    EXPECT_FALSE(l1.touch(0));
    EXPECT_TRUE(l1.touch(0));
    EXPECT_FALSE(l1.touch(1)); // of the same line
    EXPECT_TRUE(l1.touch(1));
    for (std::uint64_t line = 1; line < 16; ++line)
        EXPECT_FALSE(l1.touch(4 * line));
    EXPECT_TRUE(l1.touch(0));       // now the second line is the oldest
    EXPECT_FALSE(l1.touch(4 * 16)); // and goes
    EXPECT_TRUE(l1.touch(0));
    EXPECT_TRUE(l1.touch(4 * 2));
    EXPECT_FALSE(l1.touch(4));
}

/// Triangles and spheres, both trees, and rays through them.
class WarpModel : public ::testing::Test {
  protected:
    static constexpr std::uint32_t triangle_count = 400;

    WarpModel() {
        Random random(17);
        for (std::uint32_t i = 0; i < triangle_count; ++i) {
            const Vec3 at = random.point(-1, 1);
            for (int corner = 0; corner < 3; ++corner)
                positions_.push_back(at + 0.2f * random.point(-1, 1));
            triangles_.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        for (int i = 0; i < 40; ++i)
            spheres_.push_back({random.point(-1, 1), 0.05f});
        mesh_ = {positions_, triangles_};
        geometry_ = {{&mesh_, 1}, spheres_};
        binary_ = build_sah(geometry_, 1);
        wide_ = build_compressed(geometry_, 1);
        for (int i = 0; i < 500; ++i) {
            const Vec3 origin = 2.0f * random.direction();
            rays_.push_back({{origin, 0, random.point(-1, 1) - origin, infinity}, i % 3 == 0});
        }
    }

    [[nodiscard]] TreeViews trees() const { return {binary_.view(), wide_.view()}; }

    /// Instructions of one ray by itself.
    [[nodiscard]] double instructions_of(CudaTree tree, const Question& question) const {
        const Costs costs;
        double sum = costs.ray.all;
        for (const Step& step : steps_of(trees(), tree, question))
            sum += step.kind == StepKind::node
                       ? (tree == CudaTree::binary ? costs.binary_node : costs.wide_node).all
                       : step.count *
                             (step.kind == StepKind::sphere ? costs.sphere : costs.triangle).all;
        return sum;
    }
    [[nodiscard]] double instructions_of(CudaTree tree, std::span<const Question> rays) const {
        double sum = 0;
        for (const Question& ray : rays)
            sum += instructions_of(tree, ray);
        return sum;
    }
    [[nodiscard]] Totals run(const Kernel& kernel, std::span<const Question> rays) const {
        Multiprocessor processor(Gpu{}, Costs{}, trees(), kernel);
        std::vector<WarpWork> warps;
        for (std::size_t first = 0; first < rays.size(); first += 32) {
            const auto lanes = rays.subspan(first, std::min<std::size_t>(32, rays.size() - first));
            warps.push_back({Phase{{lanes.begin(), lanes.end()}, {}}});
        }
        kernel.refill_at > 0 ? processor.run(rays) : processor.run(warps);
        return processor.totals();
    }

    std::vector<Vec3> positions_;
    std::vector<Triangle> triangles_;
    std::vector<Sphere> spheres_;
    MeshView mesh_;
    GeometryView geometry_;
    SahTree binary_;
    CompressedTree wide_;
    std::vector<Question> rays_;
};

TEST_F(WarpModel, StepsAreThoseOfTheTraversalThatIsCounted) {
    // As many nodes and primitives as the traversal tells of by itself, at places of their arrays.
    std::size_t spheres = 0;
    for (const Question& ray : rays_)
        for (const CudaTree tree : {CudaTree::binary, CudaTree::wide}) {
            const auto steps = steps_of(trees(), tree, ray);
            ASSERT_FALSE(steps.empty());
            EXPECT_TRUE(steps[0].is_node());
            EXPECT_EQ(steps[0].address,
                      tree == CudaTree::binary
                          ? reinterpret_cast<const std::byte*>(trees().binary.nodes)
                          : reinterpret_cast<const std::byte*>(trees().wide.nodes));
            for (const Step& step : steps)
                spheres += step.kind == StepKind::sphere ? step.count : 0;
        }
    EXPECT_GT(spheres, 30u);
}

TEST_F(WarpModel, LanesDoTheirOwnStepsHoweverTheyWait) {
    for (const CudaTree tree : {CudaTree::binary, CudaTree::wide}) {
        const double alone = instructions_of(tree, rays_) / 32;
        for (const Kernel& kernel :
             {Kernel{tree}, Kernel{tree, 80, Loop::together}, Kernel{tree, 80, {}, 20},
              Kernel{tree, 255}, Kernel{tree, 80, Loop::together, 1}}) {
            const Totals totals = run(kernel, rays_);
            EXPECT_EQ(totals.rays, rays_.size());
            EXPECT_NEAR(totals.used, alone, 1e-9 * alone);
            EXPECT_GT(totals.issued, 1.2 * alone); // some wait
            EXPECT_LT(totals.issued, 32 * alone);
        }
    }
}

TEST_F(WarpModel, LanesThatDoTheSameDoNotWait) {
    for (const CudaTree tree : {CudaTree::binary, CudaTree::wide})
        for (const Loop loop : {Loop::nodes_first, Loop::together}) {
            const std::vector<Question> same(32, rays_[3]);
            const Totals totals = run({tree, 80, loop}, same);
            EXPECT_DOUBLE_EQ(totals.lanes_used(), 1);
            EXPECT_DOUBLE_EQ(totals.issued, instructions_of(tree, rays_[3]));
            const Totals single = run({tree, 80, loop}, {&rays_[3], 1});
            EXPECT_DOUBLE_EQ(single.lanes_used(), 1.0 / 32);
            EXPECT_EQ(single.l2_bytes, totals.l2_bytes); // the same sectors
            EXPECT_LT(single.l1_clocks, totals.l1_clocks);
        }
}

TEST_F(WarpModel, LoadsTakeAsManyClocksAsTheirLinesAndBytes) {
    // Bytes of a load, and loads of a node, a triangle and a sphere.
    struct Layout {
        std::size_t node_loads, triangle_loads, triangle_bytes, sphere_loads, sphere_bytes;
    };
    for (const CudaTree tree : {CudaTree::binary, CudaTree::wide}) {
        const Layout layout =
            tree == CudaTree::binary ? Layout{4, 9, 4, 4, 4} : Layout{5, 3, 16, 3, 16};
        for (const Question& ray : rays_) {
            double alone = 0, together = 0; // 32 lanes at one place: by the bytes that they get
            for (const Step& step : steps_of(trees(), tree, ray)) {
                const bool sphere = step.kind == StepKind::sphere;
                const std::size_t loads =
                    step.is_node()
                        ? layout.node_loads
                        : step.count * (sphere ? layout.sphere_loads : layout.triangle_loads);
                const std::size_t bytes = step.is_node() ? 16
                                          : sphere       ? layout.sphere_bytes
                                                         : layout.triangle_bytes;
                alone += static_cast<double>(loads);
                together += static_cast<double>(loads * bytes * 32 / 128);
            }
            EXPECT_EQ(run({tree}, {&ray, 1}).l1_clocks, alone);
            EXPECT_EQ(run({tree}, std::vector<Question>(32, ray)).l1_clocks, together);
        }
    }
    // From an empty L1 every sector that a ray touches comes once.
    for (const Question& ray : rays_) {
        std::set<std::uintptr_t> sectors;
        for (const Step& step : steps_of(trees(), CudaTree::wide, ray))
            for (std::size_t byte = 0; byte < (step.is_node() ? 80u : 48u); byte += 16)
                sectors.insert((reinterpret_cast<std::uintptr_t>(step.address) + byte) / 32);
        EXPECT_EQ(run({CudaTree::wide}, {&ray, 1}).l2_bytes,
                  32.0 * static_cast<double>(sectors.size()));
    }
    EXPECT_EQ(load_clocks(Gpu{}, 1, 32, 4), 1);
    EXPECT_EQ(load_clocks(Gpu{}, 1, 32, 16), 4);
    EXPECT_EQ(load_clocks(Gpu{}, 32, 32, 4), 8); // four lines a clock
    EXPECT_EQ(load_clocks(Gpu{}, 32, 32, 16), 8);
    EXPECT_EQ(load_clocks(Gpu{}, 5, 5, 16), 2);
}

TEST_F(WarpModel, ThreeLanesTakeWhatIsWorkedOutByHand) {
    // Lanes 0 and 1 do the same steps; lane 2, which misses the box, tests the root alone.
    const Question away{{{9, 9, 9}, 0, {1, 1, 1}, infinity}, false};
    ASSERT_EQ(steps_of(trees(), CudaTree::wide, away).size(), 1u);
    const std::vector<Question> rays{rays_[3], rays_[3], away};
    const Totals totals = run({CudaTree::wide}, rays);
    EXPECT_DOUBLE_EQ(totals.issued, instructions_of(CudaTree::wide, rays_[3]));
    EXPECT_DOUBLE_EQ(totals.used, (2 * instructions_of(CudaTree::wide, rays_[3]) +
                                   instructions_of(CudaTree::wide, away)) /
                                      32);
}

TEST_F(WarpModel, RefillingKeepsMoreLanesAtWork) {
    for (const CudaTree tree : {CudaTree::binary, CudaTree::wide})
        EXPECT_GT(run({tree, 255, {}, 24}, rays_).lanes_used(),
                  1.05 * run({tree, 255}, rays_).lanes_used());
}

TEST_F(WarpModel, EveryWarpOfALaunchGoesToOneMultiprocessor) {
    const Gpu gpu;
    std::vector<int> met(100 * 128 * 3 + 77);
    for (std::uint32_t number = 0; number < 132; ++number)
        for_warps(gpu, number, met.size(), [&](std::size_t first, std::size_t end) {
            EXPECT_LE(end - first, 32u);
            EXPECT_EQ(first / 128 % 132, number);
            for (std::size_t i = first; i < end; ++i)
                ++met[i];
        });
    EXPECT_EQ(std::ranges::count(met, 1), static_cast<std::ptrdiff_t>(met.size()));
}

TEST_F(WarpModel, SortedRaysAreTheSameRaysByOctant) {
    auto sorted = rays_;
    sort_rays(sorted);
    const auto octant = [](const Question& q) {
        return (q.ray.direction.x < 0 ? 1 : 0) + (q.ray.direction.y < 0 ? 2 : 0) +
               (q.ray.direction.z < 0 ? 4 : 0);
    };
    EXPECT_TRUE(std::ranges::is_sorted(sorted, {}, octant));
    const auto key = [](const Question& q) { return q.ray.direction; };
    EXPECT_TRUE(std::ranges::is_permutation(sorted, rays_, {}, key, key));
    // Neighbours start near one another: rays from anywhere in a cube, all in one octant.
    Random random(18);
    std::vector<Question> anywhere;
    for (int i = 0; i < 4000; ++i)
        anywhere.push_back({{random.point(0, 1), 0, {1, 1, 1}, infinity}, false});
    const auto mean_step = [](const std::vector<Question>& rays) {
        double sum = 0;
        for (std::size_t i = 1; i < rays.size(); ++i)
            sum += static_cast<double>(length(rays[i].ray.origin - rays[i - 1].ray.origin));
        return sum / static_cast<double>(rays.size() - 1);
    };
    const double before = mean_step(anywhere);
    sort_rays(anywhere);
    EXPECT_LT(mean_step(anywhere), 0.2 * before);
}

TEST(WarpClocks, TheSlowestPartHoldsUpTheRest) {
    const Gpu gpu;
    Totals totals;
    totals.issued = 400;
    EXPECT_DOUBLE_EQ(Clocks(totals, gpu).most(), 100);
    EXPECT_STREQ(Clocks(totals, gpu).bound(), "instructions");
    totals.alu = 220;
    EXPECT_DOUBLE_EQ(Clocks(totals, gpu).most(), 110);
    EXPECT_STREQ(Clocks(totals, gpu).bound(), "ALU");
    totals.l1_clocks = 120;
    EXPECT_STREQ(Clocks(totals, gpu).bound(), "L1");
    totals.l2_bytes = 130 * 23;
    EXPECT_STREQ(Clocks(totals, gpu).bound(), "L2");
    totals.latency = 140;
    EXPECT_STREQ(Clocks(totals, gpu).bound(), "latency");
    totals.memory_bytes = 1e6;
    EXPECT_STREQ(Clocks(totals, gpu).bound(), "memory");
}

TEST(WarpClocks, RegistersLimitTheWarps) {
    const Gpu gpu;
    EXPECT_EQ((Kernel{CudaTree::binary, 32}).resident(gpu), 64u);
    EXPECT_EQ((Kernel{CudaTree::binary, 72}).resident(gpu), 28u);
    EXPECT_EQ((Kernel{CudaTree::binary, 80}).resident(gpu), 24u);
    EXPECT_EQ((Kernel{CudaTree::binary, 83}).resident(gpu), 20u);
    EXPECT_EQ((Kernel{CudaTree::binary, 128}).resident(gpu), 16u);
    EXPECT_EQ((Kernel{CudaTree::binary, 255}).resident(gpu), 8u);
}

TEST(WarpPaths, AreThoseOfTheRender) {
    const Scene scene = plumb::test::load_xml(plumb::test::plain_box(),
                                              {{"side", "16"}, {"spp", "2"}, {"sampler", "sobol"}});
    const SceneTables tables(scene);
    const SahTree binary = build_sah(tables.geometry(), 1);
    const CompressedTree wide = build_compressed(tables.geometry(), 1);
    const RenderJob job = make_job(scene, tables.view());
    const auto paths = record_paths(job, binary.view());
    ASSERT_EQ(paths.size(), 512u);
    RenderStats stats;
    static_cast<void>(render(job, full_profile,
                             *make_intersector(AccelKind::sah, tables.geometry(), {}), {}, stats));
    std::uint64_t closest = 0, shadow = 0;
    for (const PathRays& path : paths)
        for (const PathVertex& vertex : path) {
            ++closest;
            shadow += vertex.shadow ? 1u : 0u;
        }
    EXPECT_EQ(closest, stats.rays.camera + stats.rays.bounce);
    EXPECT_EQ(shadow, stats.rays.shadow);

    // 512 paths are four blocks, one of which is looked at.
    const TreeViews trees{binary.view(), wide.view()};
    const PathCell mega = model_cell(trees, CudaTree::wide, paths, PathWay::megakernel);
    const PathCell wave = model_cell(trees, CudaTree::wide, paths, PathWay::wavefront);
    std::uint64_t of_first_block = 0;
    for (std::size_t i = 0; i < 128; ++i)
        for (const PathVertex& vertex : paths[i])
            of_first_block += vertex.shadow ? 2u : 1u;
    EXPECT_EQ(mega.totals.rays, of_first_block);
    EXPECT_EQ(mega.totals.memory_bytes, 0);
    EXPECT_GT(wave.totals.memory_bytes, 0);
    const PathCell sorted = model_cell(trees, CudaTree::wide, paths, PathWay::sorted_wavefront);
    EXPECT_EQ(sorted.totals.rays, wave.totals.rays); // others, as many
    EXPECT_EQ(sorted.totals.memory_bytes, wave.totals.memory_bytes);
    EXPECT_NE(sorted.totals.issued, wave.totals.issued);
    EXPECT_GT(wave.totals.lanes_used(), mega.totals.lanes_used()); // those that ended make room
}

TEST(WarpPaths, PersistentThreadsTraceTheSameRaysInOtherTurns) {
    const Scene scene = plumb::test::load_xml(
        plumb::test::plain_box(), {{"side", "128"}, {"spp", "8"}, {"sampler", "sobol"}});
    const SceneTables tables(scene);
    const SahTree binary = build_sah(tables.geometry(), 1);
    const CompressedTree wide = build_compressed(tables.geometry(), 1);
    const TreeViews trees{binary.view(), wide.view()};
    // More than the warps that are resident have lanes: those that are done take others.
    const auto paths = record_paths(make_job(scene, tables.view()), binary.view());
    const PathCell wave = model_cell(trees, CudaTree::wide, paths, PathWay::wavefront);
    const PathCell persistent =
        model_cell(trees, CudaTree::wide, paths, PathWay::persistent_wavefront);
    EXPECT_EQ(persistent.totals.rays, wave.totals.rays);
    EXPECT_NEAR(persistent.totals.used, wave.totals.used, 1e-9 * wave.totals.used);
    EXPECT_NE(persistent.totals.issued, wave.totals.issued);
}

} // namespace
} // namespace plumb::warps::test
