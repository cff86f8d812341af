/// \file  The variance of Russian roulette against its closed form, and stratified samples.

#include "tests/support/oracle_parts.h"
#include "tests/support/oracle_scenes.h"
#include "tests/support/polygon_irradiance.h"
#include "tests/support/statistics.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace plumb::test {
namespace {

/// In a furnace of one albedo that is left to its BSDF, a sample is E times a geometric sum:
/// X = E + (rho / q) B X' with B = 1 of probability q. So E[X^2] = (E^2 + 2 E rho m) / (1 -
/// rho^2 / q) with m = E / (1 - rho). Dividing by 1 - q or by nothing changes both moments.
double relative_variance(double rho, double q) {
    const double m = 1 / (1 - rho);
    return (1 + 2 * rho * m) / (1 - rho * rho / q) / (m * m) - 1;
}

Oracle grey_furnace(double rho) {
    Oracle oracle;
    oracle.name = "grey_furnace";
    oracle.xml = scene_text(camera_at({0.2, -0.5, 0.3}, {-0.4, 0.5, -1}, up_z, 40),
                            sphere({0.1, 0.2, -0.1}, 1.3,
                                   diffuse({rho, rho, rho}) + area_emitter({3, 3, 3}) +
                                       R"(<boolean name="flip_normals" value="true"/>)"));
    for (double& e : oracle.expected)
        e = 3 / (1 - rho);
    return oracle;
}

RelativeSamples furnace_samples(double rho, RouletteKind roulette) {
    return sample({grey_furnace(rho), {Estimator::bsdf, HemisphereSampling::cosine, roulette}},
                  1u << 18);
}

TEST(RouletteImage, TheVarianceOfTheConstantIsTheClosedForm) {
    for (const double rho : {0.3, 0.7}) {
        const RelativeSamples s = furnace_samples(rho, RouletteKind::constant);
        const double expected = relative_variance(rho, static_cast<double>(roulette_probability));
        EXPECT_LE(std::fabs(s.largest_z()), z_limit);
        EXPECT_NEAR(s.variance() / expected, 1, 0.03) << "albedo " << rho;
    }
}

/// The throughput is the albedo after each bounce and 1 after each roulette: q = min(0.95, rho).
TEST(RouletteImage, TheVarianceOfTheThroughputIsTheClosedForm) {
    for (const double rho : {0.3, 0.7}) {
        const RelativeSamples s = furnace_samples(rho, RouletteKind::throughput);
        EXPECT_LE(std::fabs(s.largest_z()), z_limit);
        EXPECT_NEAR(s.variance() / relative_variance(rho, rho), 1, 0.03) << "albedo " << rho;
    }
}

TEST(RouletteImage, PathsWithoutItHaveNoNoiseInAFurnace) {
    Oracle oracle = grey_furnace(0.7);
    for (double& e : oracle.expected_cut)
        e = 3 * (1 - std::pow(0.7, depth_without_roulette)) / 0.3;
    const RelativeSamples s =
        sample({oracle, {Estimator::bsdf, HemisphereSampling::cosine, RouletteKind::none}}, 4096);
    EXPECT_NEAR(s.channel[0].mean(), 1, 1e-6);
    EXPECT_LE(s.variance(), 1e-10);
}

/// One number per seed: samples of one pixel depend on each other, pixels of different seeds do
/// not.
TEST(SobolImage, TheMeanOverManySeedsIsTheClosedFormAndLessNoisy) {
    const std::vector<Oracle> oracles = polygon_oracles();
    for (const char* name : {"rectangle_light", "triangle_light", "mixed_lights"}) {
        const auto oracle = std::find_if(oracles.begin(), oracles.end(),
                                         [name](const Oracle& o) { return o.name == name; });
        ASSERT_NE(oracle, oracles.end());
        MeanTest by_kind[2];
        for (const auto kind : {SamplerKind::sobol, SamplerKind::independent})
            for (int seed = 0; seed < 60; ++seed) {
                RenderSetup setup;
                setup.parameters = {{"side", "3"}, {"spp", "64"}, {"seed", std::to_string(seed)}};
                setup.adjust = [kind](Scene& scene) { scene.sampler.kind = kind; };
                for (const Rgb& p : render_xml(oracle->xml, setup, oracle->files).image.pixels)
                    by_kind[kind == SamplerKind::sobol ? 0 : 1].add(static_cast<double>(p.g) /
                                                                    oracle->expected[1]);
            }
        EXPECT_LE(std::fabs(by_kind[0].z(1)), z_limit) << name << ' ' << by_kind[0].mean();
        EXPECT_LT(by_kind[0].variance(), 0.8 * by_kind[1].variance()) << name;
    }
}

/// The formulas of the tests against published numbers and each other.
TEST(FormFactors, AreThePublishedNumbers) {
    EXPECT_NEAR(parallel_form_factor(1, 1), 0.1998248957, 1e-10);
    // A square that fills the view: irradiance pi.
    const Double3 wide[] = {{-1e6, -1e6, 1}, {1e6, -1e6, 1}, {1e6, 1e6, 1}, {-1e6, 1e6, 1}};
    EXPECT_NEAR(polygon_irradiance(wide), pi_double, 1e-5);
    // Half of it is below the horizon: the other half alone, by symmetry half of pi.
    const Double3 wall[] = {
        {1e-7, -1e3, -1e3}, {1e-7, 1e3, -1e3}, {1e-7, 1e3, 1e3}, {1e-7, -1e3, 1e3}};
    EXPECT_NEAR(polygon_irradiance(wall), pi_double / 2, 1e-2);
}

} // namespace
} // namespace plumb::test
