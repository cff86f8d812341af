/// \file  The statistics the other tests decide with, against published values.

#include "tests/support/moments.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace plumb::test {
namespace {

TEST(Statistics, RegularizedGammaMatchesClosedForms) {
    // Q(1, x) = exp(-x); Q(1/2, x) = erfc(sqrt x); Q(3, x) = exp(-x)(1 + x + x²/2).
    for (const double x : {0.01, 0.5, 1.4, 1.6, 3.0, 10.0, 50.0}) {
        EXPECT_NEAR(regularized_gamma_q(1, x), std::exp(-x), 1e-13);
        EXPECT_NEAR(regularized_gamma_q(0.5, x), std::erfc(std::sqrt(x)), 1e-13);
        EXPECT_NEAR(regularized_gamma_q(3, x), std::exp(-x) * (1 + x + x * x / 2), 1e-13);
    }
    EXPECT_EQ(regularized_gamma_q(2, 0), 1);
    // Upper 5 % points of the chi² tables: 3.841459 (1), 18.307038 (10), 124.342113 (100).
    EXPECT_NEAR(regularized_gamma_q(0.5, 3.841459 / 2), 0.05, 1e-7);
    EXPECT_NEAR(regularized_gamma_q(5, 18.307038 / 2), 0.05, 1e-7);
    EXPECT_NEAR(regularized_gamma_q(50, 124.342113 / 2), 0.05, 1e-7);
}

TEST(Statistics, LimitsOfZAndPAreTheSameTail) {
    EXPECT_NEAR(normal_p_value(z_limit), p_limit, 0.05 * p_limit);
}

TEST(Statistics, MeanTestKeepsTheVarianceOfLargeNumbers) {
    // Uniform on [1000, 1001): mean 1000.5, variance 1/12. Squares in float would give nonsense.
    Random random(1);
    MeanTest all, first, second;
    for (int i = 0; i < 200000; ++i) {
        const double x = 1000 + random.uniform_double();
        all.add(x);
        (i < 70000 ? first : second).add(x);
    }
    EXPECT_LE(std::fabs(all.z(1000.5)), z_limit);
    EXPECT_GT(std::fabs(all.z(1000.51)), z_limit);
    EXPECT_NEAR(all.variance(), 1.0 / 12, 0.01 / 12);
    EXPECT_LE(std::fabs(z_between(first, second)), z_limit);
    first.merge(second);
    EXPECT_EQ(first.count(), all.count());
    EXPECT_NEAR(first.mean(), all.mean(), 1e-10);
    EXPECT_NEAR(first.variance(), all.variance(), 1e-10);
    EXPECT_EQ(first.max_abs(), all.max_abs());
}

TEST(Statistics, MeanTestOfAConstantIsExact) {
    MeanTest constant;
    for (int i = 0; i < 10; ++i)
        constant.add(0.1);
    EXPECT_EQ(constant.z(0.1), 0);
    EXPECT_GT(std::fabs(constant.z(0.11)), z_limit);
    constant.add(std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(std::fabs(constant.z(0.1)) <= z_limit);
}

TEST(Statistics, ChiSquareAcceptsTheRightDistributionAndRefusesAWrongOne) {
    constexpr std::size_t bins = 32;
    Random random(2);
    std::array<double, bins> flat{}, skewed{}, expected{};
    expected.fill(100000.0 / bins);
    for (int i = 0; i < 100000; ++i) {
        const double x = random.uniform_double();
        flat[static_cast<std::size_t>(x * bins)] += 1;
        skewed[static_cast<std::size_t>(std::pow(x, 1.03) * bins)] += 1;
    }
    EXPECT_GT(chi_square_p_value(flat, expected), 1e-3);
    EXPECT_LT(chi_square_p_value(skewed, expected), p_limit);
}

TEST(Statistics, ChiSquareIsUniformOverManySeeds) {
    // Under the right distribution p is itself uniform: its mean is 1/2, its variance 1/12.
    MeanTest p;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        Random random(seed);
        std::array<double, 16> seen{}, expected{};
        expected.fill(4000.0 / 16);
        for (int i = 0; i < 4000; ++i)
            seen[random.index(16)] += 1;
        p.add(chi_square_p_value(seen, expected));
    }
    EXPECT_LE(std::fabs(p.z(0.5)), z_limit);
    EXPECT_NEAR(p.variance(), 1.0 / 12, 0.2 / 12);
}

TEST(Statistics, ChiSquarePoolsThinBinsAndSeesImpossibleOnes) {
    const std::vector<double> expected{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0};
    // Pooled into two bins of five: statistic (7-5)²/5 + (3-5)²/5 = 1.6, one degree of freedom.
    const std::vector<double> seen{7, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0};
    EXPECT_NEAR(chi_square_p_value(seen, expected), std::erfc(std::sqrt(0.8)), 1e-12);
    std::vector<double> impossible = seen;
    impossible[10] = 1;
    EXPECT_EQ(chi_square_p_value(impossible, expected), 0);
}

TEST(Statistics, RandomHasTheMomentsOfUniformNumbers) {
    Random random(7);
    MeanTest mean, z;
    for (int i = 0; i < 100000; ++i) {
        mean.add(static_cast<double>(random.uniform()));
        z.add(static_cast<double>(random.direction().z));
    }
    EXPECT_LE(std::fabs(mean.z(0.5)), z_limit);
    EXPECT_NEAR(mean.variance(), 1.0 / 12, 0.01 / 12);
    EXPECT_LE(std::fabs(z.z(0)), z_limit);
    EXPECT_NEAR(z.variance(), 1.0 / 3, 0.01 / 3);
}

/// Kurtosis of the uniform distribution 9/5, of the exponential one 9, of a coin with p = 1/10
/// 1/(p(1-p)) - 3.
TEST(Moments, AreThoseOfKnownDistributions) {
    Random random(3);
    Moments uniform, exponential, coin;
    for (int i = 0; i < 400000; ++i) {
        uniform.add(1000 + random.uniform_double());
        exponential.add(-2 * std::log1p(-random.uniform_double()));
        coin.add(random.uniform_double() < 0.1 ? 7 : 2);
    }
    EXPECT_NEAR(uniform.mean(), 1000.5, 3e-3);
    EXPECT_NEAR(uniform.variance() * 12, 1, 5e-3);
    EXPECT_NEAR(uniform.kurtosis(), 1.8, 0.01);
    EXPECT_NEAR(exponential.variance(), 4, 0.1);
    EXPECT_NEAR(exponential.kurtosis(), 9, 0.6);
    EXPECT_NEAR(coin.variance(), 25 * 0.09, 0.03);
    EXPECT_NEAR(coin.kurtosis(), 1 / 0.09 - 3, 0.15);
    Moments constant;
    constant.add(2);
    constant.add(2);
    EXPECT_EQ(constant.variance(), 0);
    EXPECT_EQ(constant.kurtosis(), 1);
}

TEST(Moments, OfPartsMergeToThoseOfTheWhole) {
    Random random(4);
    Moments whole, part, parts;
    for (int i = 0; i < 5000; ++i) {
        const double x = -50 - std::log1p(-random.uniform_double());
        whole.add(x);
        part.add(x);
        if (i % 700 == 13 || i == 4999) {
            parts.merge(part);
            part = {};
        }
    }
    EXPECT_EQ(parts.count(), whole.count());
    EXPECT_NEAR(parts.mean(), whole.mean(), 1e-12);
    EXPECT_NEAR(parts.variance(), whole.variance(), 1e-11);
    EXPECT_NEAR(parts.kurtosis(), whole.kurtosis(), 1e-9);
    EXPECT_EQ(parts.max_abs(), whole.max_abs());
}

/// The spread of 2000 sample variances of 200 exponential numbers each.
TEST(Moments, TheErrorOfTheVarianceFollowsFromTheKurtosis) {
    Random random(5);
    Moments variances;
    for (int repetition = 0; repetition < 2000; ++repetition) {
        Moments sample;
        for (int i = 0; i < 200; ++i)
            sample.add(-std::log1p(-random.uniform_double()));
        variances.add(sample.variance());
    }
    EXPECT_NEAR(variances.mean(), 1, 0.03);
    EXPECT_NEAR(std::sqrt(variances.variance()) / relative_error_of_variance(9, 200), 1, 0.1);
}

} // namespace
} // namespace plumb::test
