/// \file  Every warp against its pdf: chi² over bins of equal or known probability, and means.

#include "renderer/sampling/warp.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace plumb::test {
namespace {

constexpr double pi_double = 3.14159265358979323846;

/// Counts over a grid of [0,1)^2.
class Grid {
  public:
    explicit Grid(int cells) : cells_(cells), counts_(static_cast<std::size_t>(cells * cells)) {}

    void add(double x, double y) {
        const auto cell = [&](double v) {
            return std::clamp(static_cast<int>(v * cells_), 0, cells_ - 1);
        };
        counts_[static_cast<std::size_t>(cell(x) * cells_ + cell(y))] += 1;
        ++total_;
    }
    /// p-value against `share(x0, x1)`: the probability of a row, uniform along y.
    [[nodiscard]] double p_value(const std::function<double(double, double)>& share) const {
        std::vector<double> expected;
        for (int i = 0; i < cells_; ++i)
            for (int j = 0; j < cells_; ++j)
                expected.push_back(
                    total_ / cells_ *
                    share(static_cast<double>(i) / cells_, static_cast<double>(i + 1) / cells_));
        return chi_square_p_value(counts_, expected);
    }

  private:
    int cells_;
    std::vector<double> counts_;
    double total_ = 0;
};

/// Azimuth in turns, [0, 1).
double turns(Vec3 d) {
    const double phi = std::atan2(static_cast<double>(d.y), static_cast<double>(d.x));
    const double t = phi / (2 * pi_double);
    return t < 0 ? t + 1 : t;
}

double length_error(Vec3 d) {
    const double x = static_cast<double>(d.x), y = static_cast<double>(d.y),
                 z = static_cast<double>(d.z);
    return std::fabs(std::sqrt(x * x + y * y + z * z) - 1);
}

double uniform_share(double x0, double x1) { return x1 - x0; }

/// corrections.md, uniform hemisphere: z = t, not sqrt(1 - 2t), which is NaN half of the time.
TEST(UniformHemisphere, HasMeanZOfOneHalfAndNoNanOverAMillionSamples) {
    Random random(1);
    MeanTest z;
    int bad = 0;
    for (int i = 0; i < 1000000; ++i) {
        const DirectionSample s = sample_uniform_hemisphere(random.square());
        z.add(static_cast<double>(s.direction.z));
        bad += !(s.direction.z >= 0) || !(length_error(s.direction) < 5e-7) ||
               s.pdf != uniform_hemisphere_pdf(1);
    }
    EXPECT_EQ(bad, 0);
    EXPECT_LE(std::fabs(z.z(0.5)), z_limit);
    EXPECT_NEAR(z.variance(), 1.0 / 12, 5e-4); // of a uniform z
}

TEST(UniformHemisphere, MatchesItsPdf) {
    Random random(2);
    Grid grid(20);
    for (int i = 0; i < 400000; ++i) {
        const Vec3 d = sample_uniform_hemisphere(random.square()).direction;
        grid.add(static_cast<double>(d.z), turns(d));
    }
    const double pdf = static_cast<double>(uniform_hemisphere_pdf(0.5f));
    EXPECT_GT(grid.p_value([&](double z0, double z1) { return 2 * pi_double * pdf * (z1 - z0); }),
              p_limit);
}

/// corrections.md, cosine: acos(1 - t) gives 1/2.
TEST(CosineHemisphere, HasMeanZOfTwoThirdsAtAHundredThousandSamples) {
    Random random(3);
    MeanTest z;
    for (int i = 0; i < 100000; ++i) {
        const DirectionSample s = sample_cosine_hemisphere(random.square());
        ASSERT_LT(length_error(s.direction), 5e-7);
        ASSERT_FLOAT_EQ(s.pdf, cosine_hemisphere_pdf(s.direction.z));
        z.add(static_cast<double>(s.direction.z));
    }
    EXPECT_NEAR(z.mean(), 2.0 / 3, 0.00075);
    EXPECT_LE(std::fabs(z.z(2.0 / 3)), z_limit);
}

/// The pdf z / pi integrates to z1² - z0² over a ring.
TEST(CosineHemisphere, MatchesZOverPi) {
    Random random(4);
    Grid grid(20);
    for (int i = 0; i < 400000; ++i) {
        const Vec3 d = sample_cosine_hemisphere(random.square()).direction;
        grid.add(static_cast<double>(d.z), turns(d));
    }
    const double slope = static_cast<double>(cosine_hemisphere_pdf(0.5f)) / 0.5 * pi_double;
    EXPECT_GT(grid.p_value([&](double z0, double z1) { return slope * (z1 * z1 - z0 * z0); }),
              p_limit);
}

TEST(Hemispheres, HaveNoDensityBelowTheHorizon) {
    for (const float z : {-1.0f, -0.3f, -1e-20f, -0.0f, 0.0f}) {
        EXPECT_EQ(uniform_hemisphere_pdf(z), 0.0f);
        EXPECT_EQ(cosine_hemisphere_pdf(z), 0.0f);
    }
}

TEST(UniformSphere, MatchesItsPdf) {
    Random random(5);
    Grid grid(20);
    Grid turned(20); // about another axis: the poles are no better than the rest
    for (int i = 0; i < 400000; ++i) {
        const DirectionSample s = sample_uniform_sphere(random.square());
        const Vec3 d = s.direction;
        ASSERT_FLOAT_EQ(s.pdf, static_cast<float>(1 / (4 * pi_double)));
        grid.add(0.5 + 0.5 * static_cast<double>(d.z), turns(d));
        turned.add(0.5 + 0.5 * static_cast<double>(d.x), turns({d.y, d.z, d.x}));
    }
    EXPECT_GT(grid.p_value(uniform_share), p_limit);
    EXPECT_GT(turned.p_value(uniform_share), p_limit);
}

TEST(Cone, MatchesItsPdfFromASliverToTheWholeSphere) {
    for (const float extent : {1e-12f, 1e-6f, 0.01f, 0.5f, 1.0f, 2.0f}) {
        Random random(6);
        Grid grid(16);
        double worst = 0;
        for (int i = 0; i < 200000; ++i) {
            const DirectionSample s = sample_cone(random.square(), extent);
            const Vec3 d = s.direction;
            worst = std::max(worst, length_error(d));
            ASSERT_FLOAT_EQ(s.pdf * extent, inv_two_pi);
            // 1 - cos from the sine: a float cosine next to 1 has forgotten it.
            const double sin2 = static_cast<double>(d.x) * static_cast<double>(d.x) +
                                static_cast<double>(d.y) * static_cast<double>(d.y);
            const double cosine = std::sqrt(std::max(0.0, 1 - sin2));
            const double drop = d.z > 0 ? sin2 / (1 + cosine) : 1 + cosine;
            grid.add(drop / static_cast<double>(extent), turns(d));
        }
        EXPECT_LT(worst, 5e-7) << extent;
        EXPECT_GT(grid.p_value(uniform_share), p_limit) << extent;
    }
}

/// stability.md: 1 - cos in float is 7 % wrong at distance / radius 1e3 and infinite at 6e3.
TEST(OneMinusCos, IsWithinOneInAHundredThousandUpToAMillionRadii) {
    for (double ratio = 1; ratio < 1.1e6; ratio *= 1.07) {
        const auto sin2 = static_cast<float>(1 / (ratio * ratio));
        const long double s = static_cast<long double>(sin2);
        const long double exact = s / (1 + std::sqrt(1 - s));
        const double found = static_cast<double>(one_minus_cos(sin2));
        EXPECT_LT(std::fabs(found / static_cast<double>(exact) - 1), 1e-5) << ratio;
        // and against the ratio itself, before it was rounded
        EXPECT_LT(std::fabs(found * (1 + std::sqrt(1 - 1 / (ratio * ratio))) * ratio * ratio - 1),
                  ratio < 1.01 ? 1e-3 : 1e-5)
            << ratio;
    }
    EXPECT_EQ(one_minus_cos(1.5f), 1.5f); // inside the sphere: finite, not NaN
}

/// oracles.md: a cap of half-angle a under radiance L gives the irradiance pi L sin² a.
TEST(Cone, SeesACapOfConstantRadianceAsItsClosedForm) {
    for (const double angle_deg : {0.01, 1.0, 20.0, 60.0, 89.9}) {
        const double angle = angle_deg * pi_double / 180;
        const double sine = std::sin(angle);
        const auto extent = static_cast<float>(2 * std::sin(angle / 2) * std::sin(angle / 2));
        Random random(7);
        MeanTest irradiance;
        for (int i = 0; i < 100000; ++i) {
            const DirectionSample s = sample_cone(random.square(), extent);
            irradiance.add(static_cast<double>(s.direction.z) / static_cast<double>(s.pdf));
        }
        const double exact = pi_double * sine * sine;
        if (angle_deg < 0.1) // the cosine is 1 to the last bit: no variance, rounding only
            EXPECT_NEAR(irradiance.mean() / exact, 1, 1e-6);
        else
            EXPECT_LE(std::fabs(irradiance.z(exact)), z_limit) << angle_deg;
    }
}

/// stability.md, triangle sampling: the root of u is what makes it uniform (10.8 % bias without).
TEST(TriangleWarp, IsUniform) {
    Random random(8);
    Grid grid(24);
    MeanTest b, c;
    for (int i = 0; i < 400000; ++i) {
        const Vec2 w = sample_triangle(random.square());
        ASSERT_GE(w.x, 0.0f);
        ASSERT_GE(w.y, 0.0f);
        ASSERT_LE(w.x + w.y, 1.0f + 1e-7f);
        const double x = static_cast<double>(w.x), y = static_cast<double>(w.y);
        b.add(x);
        c.add(y);
        // The area below x + y = s is s²; along a line of constant x + y all is uniform.
        grid.add((x + y) * (x + y), x + y > 0 ? y / (x + y) : 0);
    }
    EXPECT_LE(std::fabs(b.z(1.0 / 3)), z_limit);
    EXPECT_LE(std::fabs(c.z(1.0 / 3)), z_limit);
    EXPECT_GT(grid.p_value(uniform_share), p_limit);
}

TEST(Warps, AreFiniteAtTheCornersOfTheUnitSquare) {
    const float last = 1 - unit_roundoff;
    for (const float x : {0.0f, unit_roundoff, 0.5f, last})
        for (const float y : {0.0f, 0.25f, 0.5f, 0.75f, last})
            for (const DirectionSample& s :
                 {sample_uniform_hemisphere({x, y}), sample_cosine_hemisphere({x, y}),
                  sample_uniform_sphere({x, y}), sample_cone({x, y}, 0.3f)}) {
                EXPECT_LT(length_error(s.direction), 5e-7);
                EXPECT_GT(s.pdf, 0.0f);
            }
}

} // namespace
} // namespace plumb::test
