/// \file  The discrete choice, against its probabilities.

#include "accel/math/vec.h"
#include "renderer/sampling/distribution.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace plumb::test {
namespace {

/// Cumulative sums from 0 to 1, as the scene tables make them.
std::vector<float> cdf_of(const std::vector<double>& weights) {
    double total = 0;
    for (const double w : weights)
        total += w;
    std::vector<float> cdf{0};
    double sum = 0;
    for (const double w : weights) {
        sum += w;
        cdf.push_back(static_cast<float>(sum / total));
    }
    return cdf;
}

constexpr float last = 1 - unit_roundoff;

TEST(SampleDiscrete, ChoosesEachItemAsOftenAsItsProbability) {
    const std::vector<double> weights{3, 0, 1e-3, 5, 0, 0, 2, 7.5, 0.25, 0};
    const std::vector<float> cdf = cdf_of(weights);
    Random random(1);
    const int n = 1000000;
    std::vector<double> counts(weights.size()), expected;
    for (int i = 0; i < n; ++i) {
        const DiscreteSample s = sample_discrete(cdf, random.uniform());
        ASSERT_LT(s.index, weights.size());
        ASSERT_EQ(s.probability, discrete_probability(cdf, s.index));
        counts[s.index] += 1;
    }
    double total = 0;
    for (const double w : weights)
        total += w;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        expected.push_back(n * weights[i] / total);
        if (weights[i] == 0) {
            EXPECT_EQ(counts[i], 0) << i;
        }
    }
    EXPECT_GT(chi_square_p_value(counts, expected), p_limit);
}

TEST(SampleDiscrete, NeverChoosesAnItemOfProbabilityZero) {
    Random random(2);
    for (int round = 0; round < 200; ++round) {
        std::vector<double> weights(1 + random.index(40));
        for (double& w : weights)
            w = random.bits() % 2 == 0 ? 0 : random.uniform_double();
        weights[random.index(static_cast<std::uint32_t>(weights.size()))] = 1;
        const std::vector<float> cdf = cdf_of(weights);
        const auto check = [&](float u) {
            const DiscreteSample s = sample_discrete(cdf, u);
            ASSERT_LT(s.index, weights.size());
            EXPECT_GT(s.probability, 0.0f);
            EXPECT_GT(weights[s.index], 0.0);
            EXPECT_LE(cdf[s.index], u);
            EXPECT_LT(u, cdf[s.index + 1]);
        };
        check(0);
        check(last);
        for (const float edge : cdf) // on the edges and on both sides of them
            for (const float u : {std::nextafter(edge, 0.0f), edge, std::nextafter(edge, 1.0f)})
                if (u < 1)
                    check(u);
    }
}

TEST(SampleDiscrete, ServesOneItemAndManyAlike) {
    const std::vector<float> one{0, 1};
    for (const float u : {0.0f, 0.5f, last}) {
        EXPECT_EQ(sample_discrete(one, u).index, 0u);
        EXPECT_EQ(sample_discrete(one, u).probability, 1.0f);
    }
    const std::vector<float> many = cdf_of(std::vector<double>(100000, 1));
    for (std::uint32_t i = 0; i < 100000; i += 37) {
        const float middle = 0.5f * (many[i] + many[i + 1]);
        EXPECT_EQ(sample_discrete(many, middle).index, i);
    }
}

/// Items before the first and behind the last of any weight.
TEST(SampleDiscrete, SkipsZerosAtBothEnds) {
    const std::vector<float> cdf{0, 0, 0, 1, 1, 1};
    EXPECT_EQ(sample_discrete(cdf, 0).index, 2u);
    EXPECT_EQ(sample_discrete(cdf, last).index, 2u);
}

} // namespace
} // namespace plumb::test
