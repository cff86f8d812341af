/// \file  Images rendered on a GPU have the CPU's bits, for every scene of the project.

#include "cuda/cuda_render.h"
#include "tests/cuda/project_scenes.h"
#include "tests/support/render_scene.h"

#include "accel/sah/build_compressed.h"
#include "accel/sah/build_sah.h"
#include "renderer/scene/scene_tables.h"

#include <gtest/gtest.h>

namespace plumb::test {
namespace {

struct Variant {
    SamplerKind sampler = SamplerKind::sobol;
    Estimator estimator = Estimator::mis;
    TriangleTest triangle_test = TriangleTest::watertight;
    bool full_profile = false;
};

class OnDevice : public ::testing::TestWithParam<std::filesystem::path> {
  protected:
    void SetUp() override {
        try {
            static_cast<void>(cuda_device_name());
        } catch (const NoDeviceError& none) { // a device that cannot be used is a failure
            GTEST_SKIP() << none.what();
        }
    }

    static void expect_the_bits_of_the_cpu(const Variant& variant) {
        Scene scene = load_project_scene(GetParam(), {{"res", "97"}, {"spp", "4"}});
        scene.sampler.kind = variant.sampler;
        scene.path.estimator = variant.estimator;
        const SceneTables tables(scene);
        const auto sah =
            make_intersector(AccelKind::sah, tables.geometry(), {variant.triangle_test});
        const SahTree binary = build_sah(tables.geometry());
        const CompressedTree wide = build_compressed(tables.geometry());
        const TreeViews trees{binary.view(), wide.view()};
        const RenderJob job = make_job(scene, tables.view());
        const Features needed = features_of(scene);
        RenderOptions how;
        how.variance = true;
        how.force_full_profile = variant.full_profile;
        RenderStats cpu_stats;
        const Image cpu = render(job, needed, *sah, how, cpu_stats).resolve();
        for (const CudaSettings& settings : all_cuda_settings) {
            RenderStats gpu_stats;
            const Image gpu =
                render_on_cuda(job, needed, trees, variant.triangle_test, settings, how, gpu_stats)
                    .resolve();
            EXPECT_EQ(bits_of(cpu), bits_of(gpu))
                << name_of(settings.tree) << name_of(settings.schedule);
            EXPECT_EQ(cpu.variance, gpu.variance);
            EXPECT_EQ(cpu_stats.rays.camera, gpu_stats.rays.camera);
            EXPECT_EQ(cpu_stats.rays.bounce, gpu_stats.rays.bounce);
            EXPECT_EQ(cpu_stats.rays.shadow, gpu_stats.rays.shadow);
        }
    }
};

TEST_P(OnDevice, ImageHasTheBitsOfTheCpu) { expect_the_bits_of_the_cpu({}); }

TEST_P(OnDevice, FullKernelHasTheBitsOfTheCpu) {
    Variant variant;
    variant.full_profile = true;
    expect_the_bits_of_the_cpu(variant);
}

TEST_P(OnDevice, IndependentSamplesAndLightSamplingHaveTheBitsOfTheCpu) {
    expect_the_bits_of_the_cpu(
        {SamplerKind::independent, Estimator::light, TriangleTest::watertight, false});
}

TEST_P(OnDevice, MoellerTrumboreAndBsdfSamplingHaveTheBitsOfTheCpu) {
    expect_the_bits_of_the_cpu(
        {SamplerKind::sobol, Estimator::bsdf, TriangleTest::moeller_trumbore, false});
}

INSTANTIATE_TEST_SUITE_P(Scenes, OnDevice, ::testing::ValuesIn(project_scenes()),
                         project_scene_name);

} // namespace
} // namespace plumb::test
