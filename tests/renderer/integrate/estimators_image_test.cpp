/// \file  All methods estimate the same image of a scene without a closed form.

#include "tests/support/box_scenes.h"
#include "tests/support/oracle.h"
#include "tests/support/statistics.h"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace plumb::test {
namespace {

constexpr int spp = 64;

/// Independent noise in each: a seed of its own.
RenderSetup setup_of(const Method& method, int seed) {
    RenderSetup setup;
    setup.variance = true;
    setup.parameters = {
        {"side", "40"}, {"spp", std::to_string(spp)}, {"seed", std::to_string(seed)}};
    setup.adjust = [method](Scene& scene) {
        method.apply(scene);
        scene.path.max_depth = 8;
        scene.path.rr_depth = 2;
    };
    return setup;
}

struct Named {
    std::string name;
    ImageMean mean;
};

std::vector<Named> all_estimates(const std::string& xml) {
    std::vector<Method> methods = all_methods();
    for (const Estimator e : {Estimator::mis, Estimator::light})
        methods.push_back(
            {e, HemisphereSampling::cosine, RouletteKind::throughput, LightSampling::area});
    std::vector<Named> all;
    int seed = 100;
    for (const Method& m : methods)
        all.push_back({m.name(), mean_of(render_xml(xml, setup_of(m, ++seed)).image, spp)});
    for (const AccelKind accel : {AccelKind::naive, AccelKind::embree}) {
        RenderSetup setup = setup_of({}, ++seed);
        setup.accel = accel;
        all.push_back({std::string(name_of(accel)), mean_of(render_xml(xml, setup).image, spp)});
    }
    return all;
}

void expect_pairs_agree(const std::string& xml) {
    const std::vector<Named> all = all_estimates(xml);
    double largest = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const double z = largest_z(all[i].mean, all[j].mean);
            largest = std::fmax(largest, std::fabs(z));
            EXPECT_LE(std::fabs(z), z_limit) << all[i].name << " against " << all[j].name;
        }
    for (const Named& estimate : all) // the means are worth comparing: known to 2 %
        for (int c = 0; c < 3; ++c)
            EXPECT_LE(std::sqrt(estimate.mean.variance[c]), 0.02 * estimate.mean.mean[c])
                << estimate.name;
    ::testing::Test::RecordProperty("largest_z", fmt::format("{:.3f}", largest));
    fmt::print("largest |z| of {} pairs: {:.2f}\n", all.size() * (all.size() - 1) / 2, largest);
}

TEST(EstimatorsImage, EveryPairAgreesOnABoxUnderOneLamp) { expect_pairs_agree(plain_box()); }

TEST(EstimatorsImage, EveryPairAgreesOnABoxUnderLightsOfAllKinds) {
    expect_pairs_agree(rich_box());
}

/// Mean over the pixels of the variance of a sample, all channels.
double noise(const ImageMean& m) { return m.variance[0] + m.variance[1] + m.variance[2]; }

/// The write-up's two samplings of bounce directions.
TEST(HemisphereImage, MeansAgreeAndTheCosineHasTheLowerVariance) {
    for (const Estimator e : {Estimator::bsdf, Estimator::light, Estimator::mis}) {
        const Method cosine{e, HemisphereSampling::cosine};
        const Method uniform{e, HemisphereSampling::uniform};
        const ImageMean c = mean_of(render_xml(plain_box(), setup_of(cosine, 201)).image, spp);
        const ImageMean u = mean_of(render_xml(plain_box(), setup_of(uniform, 202)).image, spp);
        EXPECT_LE(std::fabs(largest_z(c, u)), z_limit) << cosine.name();
        const double ratio = noise(c) / noise(u);
        EXPECT_LT(ratio, 1) << cosine.name();
        fmt::print("{}: variance cosine / uniform {:.3f}, z of the means {:.2f}\n", cosine.name(),
                   ratio, largest_z(c, u));
        ::testing::Test::RecordProperty(cosine.name(), fmt::format("{:.3f}", ratio));
    }
}

} // namespace
} // namespace plumb::test
