/// \file  Light sampling against its pdf: where samples fall on the light, and that the pdf of a
/// sample is the pdf that a ray in the same direction is given. MIS needs both.

#include "tests/renderer/sampling/light_fixtures.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

namespace plumb::test {
namespace {

struct DensityCase {
    LightCase scene;
    LightSampling method;
};

std::vector<DensityCase> density_cases() {
    std::vector<DensityCase> cases;
    for (const LightCase& scene : light_cases())
        for (const LightSampling method : {LightSampling::solid_angle, LightSampling::area})
            cases.push_back({scene, method});
    return cases;
}

/// The emitting side only: the receiver's own side does not matter to any of these lights.
Receiver receiver_of(const LightCase& scene) { return {scene.receiver, {0, 0, 1}}; }

class LightDensity : public ::testing::TestWithParam<DensityCase> {
  protected:
    const LightCase& scene_ = GetParam().scene;
    const Receiver receiver_ = receiver_of(scene_);
    const LightSurface surface_{scene_.light, scene_.receiver,
                                GetParam().method == LightSampling::solid_angle};

    [[nodiscard]] LightSample sample(Vec2 u) const {
        return sample_light<full_profile>(scene_.light, receiver_, u, GetParam().method);
    }
    /// light_pdf towards a point of the surface, per area of [0,1]^2.
    [[nodiscard]] double density(double s, double t) const {
        const LightSurface::Point p = surface_.at(s, t);
        const Exact to_light = p.position - Exact(scene_.receiver);
        const double d2 = dot(to_light, to_light);
        const double facing = -dot(p.normal, to_light) / std::sqrt(d2);
        const float pdf =
            light_pdf<full_profile>(scene_.light, receiver_, normalize(to_light).rounded(),
                                    p.position.rounded(), GetParam().method);
        return static_cast<double>(pdf) * std::max(0.0, facing) / d2 * p.jacobian;
    }
    /// Probability of a cell of the n x n grid by the midpoint rule.
    [[nodiscard]] double probability(int i, int j) const {
        const int n = scene_.cells, m = scene_.points;
        double sum = 0;
        for (int a = 0; a < m; ++a)
            for (int b = 0; b < m; ++b)
                sum += density((i + (a + 0.5) / m) / n, (j + (b + 0.5) / m) / n);
        return sum / (n * n * m * m);
    }
    /// Share of samples that find the light: all but those on the far side of a sphere.
    [[nodiscard]] double visible_share() const {
        if (scene_.light.kind != LightKind::sphere || GetParam().method != LightSampling::area ||
            scene_.light.inside_out)
            return 1;
        const double r = static_cast<double>(scene_.light.radius);
        return surface_.area() / (4 * pi_double * r * r);
    }
};

/// chi² over cells of the light's surface, the failed samples being one more bin, and the integral
/// of the pdf over all directions.
TEST_P(LightDensity, HasTheStatedPdf) {
    const int n = scene_.cells, samples = 100000;
    const auto bins = static_cast<std::size_t>(n * n);
    std::vector<double> counts(bins), expected;
    double failed = 0, total = 0;
    Random random(1);
    for (int i = 0; i < samples; ++i) {
        const LightSample s = sample(random.square());
        if (!(s.pdf > 0)) {
            failed += 1;
            continue;
        }
        const auto [x, y] = surface_.seen_along(s.wi);
        ASSERT_FALSE(std::isnan(x) || std::isnan(y));
        const auto cell = [n](double v) { return std::clamp(static_cast<int>(v * n), 0, n - 1); };
        counts[static_cast<std::size_t>(cell(x) * n + cell(y))] += 1;
    }
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            expected.push_back(probability(i, j) * samples);
            total += expected.back() / samples;
        }
    EXPECT_NEAR(total / visible_share(), 1, 4e-3);
    if (visible_share() < 1) {
        counts.push_back(failed);
        expected.push_back((1 - visible_share()) * samples);
    } else {
        EXPECT_LE(failed, 0);
    }
    EXPECT_GT(chi_square_p_value(counts, expected), p_limit);
}

/// What MIS needs: the same number from both sides, to float's accuracy.
TEST_P(LightDensity, OfASampleIsThatOfARayInItsDirection) {
    Random random(2);
    double worst = 0;
    int found = 0;
    for (int i = 0; i < 20000; ++i) {
        const LightSample s = sample(random.square());
        ASSERT_FALSE(std::isnan(s.pdf));
        if (!(s.pdf > 0))
            continue;
        // At the limb of a sphere the cosine, hence the pdf by area, is noise of its own rounding.
        const Exact to_target = Exact(s.target) - Exact(scene_.receiver);
        if (GetParam().method == LightSampling::area && scene_.light.kind == LightKind::sphere &&
            dot(to_target, to_target) < 0.02 * static_cast<double>(s.pdf * scene_.light.area))
            continue;
        ++found;
        // The target is moved off the light; a ray's hit is not.
        const Exact target(s.target), normal(scene_.light.normal);
        const double off = dot(target - Exact(scene_.light.origin), normal);
        const Vec3 hit = (target - normal * off).rounded();
        const float pdf = light_pdf<full_profile>(
            scene_.light, receiver_, s.wi, scene_.light.kind == LightKind::sphere ? s.target : hit,
            GetParam().method);
        worst = std::max(worst, std::fabs(static_cast<double>(pdf / s.pdf) - 1));
        EXPECT_NEAR(length(Exact(s.wi)), 1, 5e-7);
        EXPECT_EQ(s.radiance, scene_.light.emission);
        EXPECT_FALSE(s.delta);
        EXPECT_FALSE(s.infinite);
    }
    EXPECT_GT(found, 50);
    EXPECT_LT(worst, 1e-3);
}

/// A shadow ray ends at the target: it lies on the light, in the direction of the sample.
TEST_P(LightDensity, TargetsLieOnTheLightInTheDirectionOfTheSample) {
    Random random(3);
    for (int i = 0; i < 5000; ++i) {
        const LightSample s = sample(random.square());
        if (!(s.pdf > 0))
            continue;
        const Exact to_target = Exact(s.target) - Exact(scene_.receiver);
        const double distance = length(to_target);
        // Flat targets are moved off by the error of the triangle test too: 1e-5 of the size, in
        // slivers more, as plane_slack derives.
        const Exact edge1(scene_.light.edge1), edge2(scene_.light.edge2);
        const double longest = std::max({length(edge1), length(edge2), length(edge2 - edge1)});
        const bool triangle = scene_.light.kind == LightKind::triangle;
        const double sliver =
            triangle ? 0x1p-23 * longest * longest * longest / length(cross(edge1, edge2)) : 0;
        const double rounding =
            sliver +
            2e-6 * (length(Exact(scene_.light.edge1)) + length(Exact(scene_.light.edge2))) +
            1e-6 * (length(Exact(s.target)) + length(Exact(scene_.receiver)) +
                    length(Exact(scene_.light.origin)) + static_cast<double>(scene_.light.radius));
        ASSERT_LT(length(to_target - Exact(s.wi) * distance), 1e-6 * distance + 4 * rounding);
        if (scene_.light.kind == LightKind::sphere) {
            const double off = length(Exact(s.target) - Exact(scene_.light.origin)) -
                               static_cast<double>(scene_.light.radius);
            ASSERT_LT(std::fabs(off), rounding);
            if (scene_.light.inside_out)
                ASSERT_LE(off, 0);
            else
                ASSERT_GE(off, 0);
        } else { // in front of the plane by rounding only, never behind it
            const double off =
                dot(Exact(s.target) - Exact(scene_.light.origin),
                    normalize(cross(Exact(scene_.light.edge1), Exact(scene_.light.edge2))));
            ASSERT_GE(off, 0);
            ASSERT_LT(off, 4 * rounding);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, LightDensity, ::testing::ValuesIn(density_cases()), [](const auto& tested) {
        return tested.param.scene.name +
               (tested.param.method == LightSampling::area ? "_by_area" : "_by_solid_angle");
    });

} // namespace
} // namespace plumb::test
