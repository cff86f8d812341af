/// \file  The diffuse BSDF: samples against the pdf, reciprocity, energy.

#include "renderer/shading/bsdf.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace plumb::test {
namespace {

constexpr double pi_double = 3.14159265358979323846;
const Material material{MaterialKind::diffuse, {0.2f, 0.7f, 1}};
const Vec3 wo{0.48f, -0.6f, 0.64f};

class DiffuseBsdf : public ::testing::TestWithParam<HemisphereSampling> {};

/// chi² over rings of z and sectors of the azimuth; the pdf integrated by the midpoint rule.
TEST_P(DiffuseBsdf, SamplesMatchThePdf) {
    const int rings = 16, sectors = 16, n = 400000;
    std::vector<double> counts(rings * sectors), expected;
    Random random(1);
    for (int i = 0; i < n; ++i) {
        const BsdfSample s = sample_bsdf(material, wo, random.square(), GetParam());
        ASSERT_GT(s.pdf, 0.0f);
        const double z = static_cast<double>(s.wi.z);
        const double phi = std::atan2(static_cast<double>(s.wi.y), static_cast<double>(s.wi.x));
        const int ring = std::clamp(static_cast<int>(z * rings), 0, rings - 1);
        const int sector =
            std::clamp(static_cast<int>((phi / (2 * pi_double) + 0.5) * sectors), 0, sectors - 1);
        counts[static_cast<std::size_t>(ring * sectors + sector)] += 1;
    }
    for (int ring = 0; ring < rings; ++ring) {
        double share = 0;
        for (int k = 0; k < 32; ++k) {
            const auto z = static_cast<float>((ring + (k + 0.5) / 32) / rings);
            const Vec3 wi{std::sqrt(1 - z * z), 0, z};
            share += static_cast<double>(bsdf_pdf(material, wo, wi, GetParam())) / 32 / rings;
        }
        for (int sector = 0; sector < sectors; ++sector)
            expected.push_back(n * share * 2 * pi_double / sectors);
    }
    EXPECT_GT(chi_square_p_value(counts, expected), p_limit);
}

/// weight = f cos / pdf, and the pdf of the sample is bsdf_pdf of its direction.
TEST_P(DiffuseBsdf, WeightsAreTheValueOverThePdf) {
    Random random(2);
    for (int i = 0; i < 100000; ++i) {
        const BsdfSample s = sample_bsdf(material, wo, random.square(), GetParam());
        const Rgb value = bsdf_times_cos(material, wo, s.wi);
        ASSERT_FLOAT_EQ(s.pdf, bsdf_pdf(material, wo, s.wi, GetParam()));
        ASSERT_NEAR(s.weight.r, value.r / s.pdf, 1e-6f);
        ASSERT_NEAR(s.weight.g, value.g / s.pdf, 1e-6f);
        ASSERT_NEAR(s.weight.b, value.b / s.pdf, 2e-6f);
        ASSERT_NEAR(length(s.wi), 1, 5e-7);
    }
}

/// The mean weight is the albedo: what is reflected of a uniform sky. No channel gains energy.
TEST_P(DiffuseBsdf, ReflectsItsReflectanceAndNoMore) {
    Random random(3);
    MeanTest r, g, b;
    for (int i = 0; i < 200000; ++i) {
        const BsdfSample s = sample_bsdf(material, wo, random.square(), GetParam());
        r.add(static_cast<double>(s.weight.r));
        g.add(static_cast<double>(s.weight.g));
        b.add(static_cast<double>(s.weight.b));
    }
    EXPECT_LE(std::fabs(r.z(static_cast<double>(0.2f))), z_limit);
    EXPECT_LE(std::fabs(g.z(static_cast<double>(0.7f))), z_limit);
    EXPECT_LE(std::fabs(b.z(1)), z_limit);
    EXPECT_LT(b.max_abs(), 2.0 + 1e-6);
}

TEST_P(DiffuseBsdf, HasNothingBelowTheSurface) {
    for (const float z : {-1.0f, -0.5f, -1e-6f, 0.0f}) {
        const Vec3 wi{std::sqrt(1 - z * z), 0, z};
        EXPECT_EQ(bsdf_pdf(material, wo, wi, GetParam()), 0.0f);
        EXPECT_EQ(bsdf_times_cos(material, wo, wi), (Rgb{0, 0, 0}));
    }
}

INSTANTIATE_TEST_SUITE_P(Hemispheres, DiffuseBsdf,
                         ::testing::Values(HemisphereSampling::cosine, HemisphereSampling::uniform),
                         [](const auto& tested) {
                             return tested.param == HemisphereSampling::cosine ? "cosine"
                                                                               : "uniform";
                         });

/// f(wo, wi) cos_i / cos_i = f(wi, wo) cos_o / cos_o.
TEST(Bsdf, IsReciprocal) {
    Random random(4);
    for (int i = 0; i < 10000; ++i) {
        Vec3 a = random.direction(), b = random.direction();
        a.z = max(std::fabs(a.z), 1e-3f);
        b.z = max(std::fabs(b.z), 1e-3f);
        const Rgb forth = bsdf_times_cos(material, a, b) * (1 / b.z);
        const Rgb back = bsdf_times_cos(material, b, a) * (1 / a.z);
        ASSERT_FLOAT_EQ(forth.r, back.r);
        ASSERT_FLOAT_EQ(forth.g, back.g);
        ASSERT_FLOAT_EQ(forth.b, back.b);
    }
}

/// Directional albedo by the midpoint rule: the reflectance, for every channel.
TEST(Bsdf, ConservesEnergy) {
    double sum = 0;
    const int n = 1000;
    for (int i = 0; i < n; ++i) {
        const auto z = static_cast<float>((i + 0.5) / n);
        const Rgb f = bsdf_times_cos(material, wo, {std::sqrt(1 - z * z), 0, z});
        sum += static_cast<double>(f.b) * 2 * pi_double / n;
    }
    EXPECT_NEAR(sum, 1, 1e-5);
}

/// The cosine never draws a direction of zero weight; both are finite at the corners.
TEST(Bsdf, IsFiniteAtTheCornersOfTheUnitSquare) {
    const float last = 1 - unit_roundoff;
    for (const float x : {0.0f, 0.5f, last})
        for (const float y : {0.0f, 0.25f, last})
            for (const auto h : {HemisphereSampling::cosine, HemisphereSampling::uniform}) {
                const BsdfSample s = sample_bsdf(material, wo, {x, y}, h);
                EXPECT_TRUE(std::isfinite(s.weight.b) && std::isfinite(s.pdf) && s.pdf > 0);
                EXPECT_GE(s.wi.z, 0.0f);
            }
}

} // namespace
} // namespace plumb::test
