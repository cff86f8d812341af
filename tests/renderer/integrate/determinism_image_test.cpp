/// \file  The same scene gives the same bits, however it is rendered.

#include "tests/support/box_scenes.h"
#include "tests/support/render_scene.h"

#include "renderer/io/compare_images.h"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>

namespace plumb::test {
namespace {

constexpr int side = 40; // not a multiple of the tile size

/// Both kernels: the lean and the general one. Both samplers.
struct Case {
    const char* name;
    std::string (*xml)();
    const char* sampler;
};

RenderSetup setup_of(const Case& c, const char* spp = "4") {
    RenderSetup setup;
    setup.parameters = {
        {"side", std::to_string(side)}, {"spp", spp}, {"sampler", c.sampler}, {"seed", "7"}};
    setup.adjust = [](Scene& scene) {
        scene.path.max_depth = 8;
        scene.path.rr_depth = 2;
    };
    return setup;
}

class Determinism : public ::testing::TestWithParam<Case> {
  protected:
    static Rendered render_with(const RenderSetup& setup) {
        return render_xml(GetParam().xml(), setup);
    }
    static const Rendered& reference() { // naive, one thread
        static std::map<std::string, Rendered> done;
        const auto found = done.find(GetParam().name);
        if (found != done.end())
            return found->second;
        RenderSetup setup = setup_of(GetParam());
        setup.accel = AccelKind::naive;
        return done[GetParam().name] = render_with(setup);
    }
    static void expect_same(const Rendered& a, const Rendered& b) {
        EXPECT_EQ(bits_of(a.image), bits_of(b.image));
        EXPECT_EQ(a.stats.rays.camera, b.stats.rays.camera);
        EXPECT_EQ(a.stats.rays.bounce, b.stats.rays.bounce);
        EXPECT_EQ(a.stats.rays.shadow, b.stats.rays.shadow);
    }
};

TEST_P(Determinism, NaiveAndSahGiveTheSameBits) {
    expect_same(render_with(setup_of(GetParam())), reference());
}

TEST_P(Determinism, NaiveAndSahGiveTheSameBitsWithMoellerTrumbore) {
    RenderSetup setup = setup_of(GetParam());
    setup.build.triangle_test = TriangleTest::moeller_trumbore;
    const Rendered sah = render_with(setup);
    setup.accel = AccelKind::naive;
    expect_same(sah, render_with(setup));
}

TEST_P(Determinism, EveryNumberOfThreadsGivesTheSameBits) {
    for (const int threads : {1, 2, 3, 4, 8}) {
        SCOPED_TRACE(threads);
        RenderSetup setup = setup_of(GetParam());
        setup.threads = threads;
        expect_same(render_with(setup), reference());
    }
}

TEST_P(Determinism, KeepingTheVarianceChangesNoBit) {
    RenderSetup setup = setup_of(GetParam());
    setup.variance = true;
    expect_same(render_with(setup), reference());
}

TEST_P(Determinism, TheGeneralKernelGivesTheSameBits) {
    RenderSetup setup = setup_of(GetParam());
    setup.full_profile = true;
    const Rendered general = render_with(setup);
    expect_same(general, reference());
    const bool lean = GetParam().xml == plain_box;
    EXPECT_EQ(general.stats.profile != reference().stats.profile, lean)
        << "plain_box is there to run another kernel: " << reference().stats.profile;
}

TEST_P(Determinism, ACropHoldsThePixelsOfTheWholeImage) {
    const Image& whole = reference().image;
    for (const Crop crop : {Crop{0, 0, 5, 3}, Crop{17, 9, 19, 22}, Crop{39, 39, 1, 1}}) {
        RenderSetup setup = setup_of(GetParam());
        setup.adjust = [crop, inner = setup.adjust](Scene& scene) {
            inner(scene);
            scene.film.crop = crop;
        };
        const Image part = render_with(setup).image;
        ASSERT_EQ(part.width, crop.width);
        ASSERT_EQ(part.height, crop.height);
        for (int y = 0; y < crop.height; ++y)
            for (int x = 0; x < crop.width; ++x) {
                const auto here = static_cast<std::size_t>(y * crop.width + x);
                const auto there = static_cast<std::size_t>((y + crop.y) * side + x + crop.x);
                ASSERT_EQ(std::memcmp(&part.pixels[here], &whole.pixels[there], sizeof(Rgb)), 0)
                    << "pixel " << x << ' ' << y << " of the crop at " << crop.x << ' ' << crop.y;
            }
    }
}

TEST_P(Determinism, AnotherSeedGivesAnotherImage) {
    RenderSetup setup = setup_of(GetParam());
    setup.parameters.back().second = "8";
    EXPECT_NE(bits_of(render_with(setup).image), bits_of(reference().image));
}

/// Embree rounds t, u and v in its own way: most paths are the same, a few meet an edge on its
/// other side and become another sample of the same pixel.
TEST_P(Determinism, EmbreeDiffersWithinTheNoise) {
    constexpr double spp = 64;
    RenderSetup setup = setup_of(GetParam(), "64");
    setup.variance = true;
    const Image sah = render_with(setup).image;
    setup.accel = AccelKind::embree;
    const Image embree = render_with(setup).image;
    const ZTest same_numbers = z_test(embree, spp, sah, spp);
    EXPECT_TRUE(same_numbers.passes())
        << same_numbers.failed << " pixels, largest z " << same_numbers.largest_z;
    // Far closer than noise would be: the random numbers are the same.
    const ImageComparison difference = compare(embree, sah);
    const ImageMean noise = mean_of(sah, spp);
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_LE(std::fabs(difference.mean_a[c] - difference.mean_b[c]),
                  0.5 * std::sqrt(noise.variance[c]));
}

std::string name_of_case(const ::testing::TestParamInfo<Case>& tested) { return tested.param.name; }

INSTANTIATE_TEST_SUITE_P(Image, Determinism,
                         ::testing::Values(Case{"plain_independent", plain_box, "independent"},
                                           Case{"plain_sobol", plain_box, "sobol"},
                                           Case{"rich_independent", rich_box, "independent"},
                                           Case{"rich_sobol", rich_box, "sobol"}),
                         name_of_case);

TEST(DeterminismImage, BothDialectsGiveTheSameBits) {
    ASSERT_NE(plain_box(), plain_box_in_dialect_06());
    const RenderSetup setup = setup_of({"", plain_box, "sobol"});
    EXPECT_EQ(bits_of(render_xml(plain_box_in_dialect_06(), setup).image),
              bits_of(render_xml(plain_box(), setup).image));
}

} // namespace
} // namespace plumb::test
