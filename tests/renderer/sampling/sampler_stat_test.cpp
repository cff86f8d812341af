/// \file  The samplers' statistics: unbiased over pixels and seeds, uniform, independent where they
/// claim it, and less noisy than chance.

#include "renderer/sampling/sampler.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace plumb::test {
namespace {

/// x in double.
std::array<double, 4> numbers(const Sampler& sampler, std::uint32_t group) {
    const Sample4 s = sampler.group(group);
    return {static_cast<double>(s.x[0]), static_cast<double>(s.x[1]), static_cast<double>(s.x[2]),
            static_cast<double>(s.x[3])};
}

class SamplerStatistics : public ::testing::TestWithParam<SamplerKind> {};

/// The scramble itself: one sample index, many pixels and seeds. Each number, its square and the
/// products with its neighbours and with the next groups.
TEST_P(SamplerStatistics, HaveUnbiasedMeansOverPixelsAndSeeds) {
    for (const std::uint32_t sample : {0u, 1u, 5u, 1000u}) {
        std::array<MeanTest, 4> first, second, pairs, across;
        MeanTest all;
        for (std::uint32_t seed = 0; seed < 20; ++seed)
            for (std::uint32_t pixel = 0; pixel < 5000; ++pixel) {
                const Sampler sampler(GetParam(), seed, pixel, sample);
                const auto a = numbers(sampler, 0), b = numbers(sampler, 1),
                           c = numbers(sampler, 2);
                for (std::size_t d = 0; d < 4; ++d) {
                    const std::size_t e = (d + 1) % 4;
                    for (const auto& x : {a, b, c}) {
                        first[d].add(x[d]);
                        second[d].add(x[d] * x[d]);
                        pairs[d].add(x[d] * x[e]);
                    }
                    across[d].add(a[d] * b[d]);
                    across[e].add(b[d] * c[e]);
                }
                all.add(a[0] * a[1] * a[2] * a[3] * b[0] * b[1] * c[2] * c[3]);
            }
        for (std::size_t d = 0; d < 4; ++d) {
            EXPECT_LE(std::fabs(first[d].z(0.5)), z_limit) << sample << ' ' << d;
            EXPECT_LE(std::fabs(second[d].z(1.0 / 3)), z_limit) << sample << ' ' << d;
            EXPECT_LE(std::fabs(pairs[d].z(0.25)), z_limit) << sample << ' ' << d;
            EXPECT_LE(std::fabs(across[d].z(0.25)), z_limit) << sample << ' ' << d;
            EXPECT_NEAR(first[d].variance(), 1.0 / 12, 2e-3);
        }
        EXPECT_LE(std::fabs(all.z(std::ldexp(1, -8))), z_limit) << sample;
    }
}

/// Means of N samples of a pixel: what an image is made of. No bias at any N; a peer has 0.35 %.
TEST_P(SamplerStatistics, HaveUnbiasedPixelMeansAtEveryCount) {
    const std::vector<std::function<double(double, double)>> functions{
        [](double x, double) { return x; }, [](double x, double) { return x * x; },
        [](double x, double y) { return x * y; },
        [](double x, double y) { return x * x + y * y < 1 ? 1.0 : 0.0; },
        [](double x, double) { return x < 0.3 ? 1.0 : 0.0; }};
    const double exact[] = {0.5, 1.0 / 3, 0.25, 0.78539816339744831, 0.3};
    for (const std::uint32_t n : {1u, 3u, 4u, 16u, 64u})
        for (const std::uint32_t group : {0u, 1u, 4u}) {
            std::array<MeanTest, 5> even, odd; // dimensions (0,1) and (2,3)
            for (std::uint32_t pixel = 0; pixel < 60000 / n; ++pixel) {
                std::array<double, 5> mean{}, mean23{};
                for (std::uint32_t i = 0; i < n; ++i) {
                    const auto x = numbers(Sampler(GetParam(), pixel / 1000, pixel, i), group);
                    for (std::size_t f = 0; f < functions.size(); ++f) {
                        mean[f] += functions[f](x[0], x[1]) / n;
                        mean23[f] += functions[f](x[2], x[3]) / n;
                    }
                }
                for (std::size_t f = 0; f < functions.size(); ++f) {
                    even[f].add(mean[f]);
                    odd[f].add(mean23[f]);
                }
            }
            for (std::size_t f = 0; f < functions.size(); ++f) {
                EXPECT_LE(std::fabs(even[f].z(exact[f])), z_limit) << n << ' ' << group << ' ' << f;
                EXPECT_LE(std::fabs(odd[f].z(exact[f])), z_limit) << n << ' ' << group << ' ' << f;
            }
        }
}

/// chi² over 64 strata of one number, and 16 x 16 of a pair, at one sample index over pixels.
TEST_P(SamplerStatistics, AreUniformInOneAndTwoDimensionsOverPixels) {
    struct Pair {
        std::uint32_t group_a, group_b;
        std::size_t a, b;
    };
    std::vector<Pair> pairs;
    for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b) {
            if (a < b)
                pairs.push_back({1, 1, a, b});
            pairs.push_back({0, 1, a, b});
            pairs.push_back({1, 2, a, b});
            pairs.push_back({3, 20, a, b});
        }
    const int n = 50000;
    for (const Pair& p : pairs) {
        std::vector<double> square(256), line(64);
        for (std::uint32_t pixel = 0; pixel < n; ++pixel) {
            const Sampler sampler(GetParam(), 11, pixel, 2);
            const double x = numbers(sampler, p.group_a)[p.a];
            const double y = numbers(sampler, p.group_b)[p.b];
            square[static_cast<std::size_t>(x * 16) * 16 + static_cast<std::size_t>(y * 16)] += 1;
            line[static_cast<std::size_t>(y * 64)] += 1;
        }
        const std::string name = std::to_string(p.group_a) + '.' + std::to_string(p.a) + ' ' +
                                 std::to_string(p.group_b) + '.' + std::to_string(p.b);
        EXPECT_GT(chi_square_p_value(line, std::vector<double>(64, n / 64.0)), p_limit) << name;
        EXPECT_GT(chi_square_p_value(square, std::vector<double>(256, n / 256.0)), p_limit) << name;
    }
}

/// Neighbouring pixels, seeds and, across pixels, samples: 16 x 16 strata of the same number.
TEST_P(SamplerStatistics, AreIndependentBetweenPixelsAndSeeds) {
    const int n = 100000;
    struct Step {
        std::uint32_t pixel;
        std::uint64_t seed;
        const char* name;
    };
    for (const Step& step :
         {Step{1, 0, "next pixel"}, Step{256, 0, "pixel below"}, Step{1u << 16, 0, "far pixel"},
          Step{0, 1, "next seed"}, Step{0, 1ull << 32, "upper half of the seed"}})
        for (const std::uint32_t group : {0u, 1u, 2u})
            for (std::size_t d = 0; d < 4; ++d) {
                std::vector<double> counts(256);
                MeanTest product;
                for (std::uint32_t i = 0; i < n; ++i) {
                    const double x = numbers(Sampler(GetParam(), 3, 2 * i, 1), group)[d];
                    const double y = numbers(
                        Sampler(GetParam(), 3 + step.seed, 2 * i + step.pixel, 1), group)[d];
                    counts[static_cast<std::size_t>(x * 16) * 16 +
                           static_cast<std::size_t>(y * 16)] += 1;
                    product.add((x - 0.5) * (y - 0.5));
                }
                EXPECT_GT(chi_square_p_value(counts, std::vector<double>(256, n / 256.0)), p_limit)
                    << step.name << ' ' << group << ' ' << d;
                EXPECT_LE(std::fabs(product.z(0)), z_limit)
                    << step.name << ' ' << group << ' ' << d;
            }
}

/// Inside a pixel: no number of one group follows one of another. The mean of n products of
/// centred numbers has the variance 1/(144 n) for independent samples. A nested shuffle pairs the
/// halves of two groups n/2 times, not n times, and 3/4 of the variance is in the halves: padding
/// may reach 1.75 of that where nothing but the interaction counts.
TEST_P(SamplerStatistics, AreUncorrelatedBetweenGroupsInsideAPixel) {
    const std::uint32_t n = 64, pixels = 600;
    for (const auto& [g, h] : {std::pair{0u, 1u}, {1u, 2u}, {2u, 3u}, {1u, 4u}}) {
        std::array<std::array<MeanTest, 4>, 4> means;
        for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
            std::array<std::array<double, 4>, 4> sums{};
            for (std::uint32_t i = 0; i < n; ++i) {
                const Sampler sampler(GetParam(), 1, pixel, i);
                const auto x = numbers(sampler, g), y = numbers(sampler, h);
                for (std::size_t a = 0; a < 4; ++a)
                    for (std::size_t b = 0; b < 4; ++b)
                        sums[a][b] += (x[a] - 0.5) * (y[b] - 0.5) / n;
            }
            for (std::size_t a = 0; a < 4; ++a)
                for (std::size_t b = 0; b < 4; ++b)
                    means[a][b].add(sums[a][b]);
        }
        for (std::size_t a = 0; a < 4; ++a)
            for (std::size_t b = 0; b < 4; ++b) {
                EXPECT_LE(std::fabs(means[a][b].z(0)), z_limit) << g << h << a << b;
                EXPECT_LT(means[a][b].variance() * 144 * n, 2.2) << g << h << a << b;
            }
    }
}

INSTANTIATE_TEST_SUITE_P(All, SamplerStatistics,
                         ::testing::Values(SamplerKind::sobol, SamplerKind::independent),
                         [](const auto& tested) {
                             return tested.param == SamplerKind::sobol ? "sobol" : "independent";
                         });

/// One pixel's independent samples in a row.
TEST(IndependentSampler, IsUniformInOneAndTwoDimensionsOverSamples) {
    const int n = 500000;
    for (const std::uint32_t group : {0u, 1u, 7u})
        for (std::size_t d = 0; d < 4; ++d) {
            std::vector<double> line(256), square(1024), lag(1024);
            double before = 0;
            for (std::uint32_t i = 0; i < n; ++i) {
                const auto x = numbers(Sampler(SamplerKind::independent, 8, 99, i), group);
                const double y = x[(d + 1) % 4];
                line[static_cast<std::size_t>(x[d] * 256)] += 1;
                square[static_cast<std::size_t>(x[d] * 32) * 32 +
                       static_cast<std::size_t>(y * 32)] += 1;
                lag[static_cast<std::size_t>(x[d] * 32) * 32 +
                    static_cast<std::size_t>(before * 32)] += 1;
                before = x[d];
            }
            const auto flat = [&](std::size_t bins) {
                return std::vector<double>(bins,
                                           static_cast<double>(n) / static_cast<double>(bins));
            };
            EXPECT_GT(chi_square_p_value(line, flat(256)), p_limit) << group << ' ' << d;
            EXPECT_GT(chi_square_p_value(square, flat(1024)), p_limit) << group << ' ' << d;
            EXPECT_GT(chi_square_p_value(lag, flat(1024)), p_limit) << group << ' ' << d;
        }
}

/// Variance over pixels of the mean of n samples of f.
double variance_of_means(SamplerKind kind, std::uint32_t n,
                         const std::function<double(const Sampler&)>& f) {
    MeanTest means;
    for (std::uint32_t pixel = 0; pixel < 300; ++pixel) {
        double sum = 0;
        for (std::uint32_t i = 0; i < n; ++i)
            sum += f(Sampler(kind, 2, pixel, i));
        means.add(sum / n);
    }
    return means.variance();
}

/// A smooth product of four factors in one group: scrambled nets converge faster than chance.
TEST(SobolSampler, ReducesTheVarianceOfASmoothIntegrand) {
    for (const std::uint32_t group : {0u, 1u, 6u}) {
        const auto f = [group](const Sampler& s) {
            double product = 1;
            for (const double x : numbers(s, group))
                product *= 1 + 0.5 * std::sin(3 * x);
            return product;
        };
        const auto ratio = [&](std::uint32_t n) {
            return variance_of_means(SamplerKind::sobol, n, f) /
                   variance_of_means(SamplerKind::independent, n, f);
        };
        EXPECT_LT(ratio(16), 0.1) << group;
        EXPECT_LT(ratio(256), 0.01) << group;
        EXPECT_LT(ratio(100), 0.1) << group; // no power of two
    }
}

/// Edges of light and shadow in two dimensions.
TEST(SobolSampler, ReducesTheVarianceOfAnEdge) {
    const auto edge = [](const Sampler& s) {
        const auto x = numbers(s, 1);
        return x[0] + 0.37 * x[1] < 0.61 ? 1.0 : 0.0;
    };
    EXPECT_LT(variance_of_means(SamplerKind::sobol, 64, edge),
              0.25 * variance_of_means(SamplerKind::independent, 64, edge));
}

/// Several groups together gain less, but never lose.
TEST(SobolSampler, IsNoNoisierThanChanceAcrossGroups) {
    const auto f = [](const Sampler& s) {
        double product = 1;
        for (std::uint32_t g = 0; g < 5; ++g)
            product *= 1 + numbers(s, g)[g % 4] * numbers(s, g)[(g + 1) % 4];
        return product;
    };
    EXPECT_LT(variance_of_means(SamplerKind::sobol, 64, f),
              0.5 * variance_of_means(SamplerKind::independent, 64, f));
    const auto hard = [](const Sampler& s) { // only the interaction of two groups: see above
        return (numbers(s, 1)[0] < 0.5) == (numbers(s, 2)[2] < 0.5) ? 1.0 : 0.0;
    };
    EXPECT_LT(variance_of_means(SamplerKind::sobol, 64, hard),
              2.5 * variance_of_means(SamplerKind::independent, 64, hard));
}

} // namespace
} // namespace plumb::test
