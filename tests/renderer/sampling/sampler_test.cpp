/// \file  The samplers' structure: published points, strata and nets, purity.

#include "renderer/sampling/sampler.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace plumb::test {
namespace {

constexpr SamplerKind kinds[] = {SamplerKind::sobol, SamplerKind::independent};

/// Whether every bin holds one.
bool one_each(const std::vector<int>& bins) {
    return std::all_of(bins.begin(), bins.end(), [](int count) { return count == 1; });
}

/// The unscrambled point of an index, from the direction numbers alone.
std::vector<double> sobol_point(std::uint32_t index) {
    const detail::SobolRows rows = detail::make_sobol_rows();
    std::vector<double> point;
    for (std::size_t d = 0; d < 4; ++d) {
        std::uint32_t bits = 0;
        for (std::uint32_t i = 0; i < 32; ++i)
            if (((index >> i) & 1u) != 0)
                bits ^= rows.row[i].x[d];
        point.push_back(static_cast<double>(detail::reverse_bits(bits)) * 0x1p-32);
    }
    return point;
}

/// The first points of new-joe-kuo-6 in four dimensions, as S. Joe and F. Kuo's own program
/// prints them: in Gray code order.
TEST(SobolRows, GiveThePublishedFirstPoints) {
    const std::vector<std::vector<double>> published{
        {0, 0, 0, 0},
        {0.5, 0.5, 0.5, 0.5},
        {0.75, 0.25, 0.25, 0.25},
        {0.25, 0.75, 0.75, 0.75},
        {0.375, 0.375, 0.625, 0.875},
        {0.875, 0.875, 0.125, 0.375},
        {0.625, 0.125, 0.875, 0.625},
        {0.125, 0.625, 0.375, 0.125},
        {0.1875, 0.3125, 0.9375, 0.4375},
        {0.6875, 0.8125, 0.4375, 0.9375},
        {0.9375, 0.0625, 0.6875, 0.1875},
        {0.4375, 0.5625, 0.1875, 0.6875},
        {0.3125, 0.1875, 0.3125, 0.5625},
        {0.8125, 0.6875, 0.8125, 0.0625},
        {0.5625, 0.4375, 0.0625, 0.8125},
        {0.0625, 0.9375, 0.5625, 0.3125},
    };
    for (std::uint32_t i = 0; i < published.size(); ++i)
        EXPECT_EQ(sobol_point(i ^ (i >> 1)), published[i]) << i;
}

/// Every direction number has its leading bit: each dimension alone is a permutation.
TEST(SobolRows, AreUnitTriangular) {
    const detail::SobolRows rows = detail::make_sobol_rows();
    for (std::uint32_t i = 0; i < 32; ++i)
        for (const std::uint32_t bits : rows.row[i].x) {
            EXPECT_EQ((bits >> i) & 1u, 1u);
            EXPECT_EQ(i < 31 ? bits >> (i + 1) : 0, 0u);
        }
}

TEST(ReverseBits, IsItsOwnInverse) {
    EXPECT_EQ(detail::reverse_bits(1), 0x80000000u);
    EXPECT_EQ(detail::reverse_bits(0x12345678u), 0x1e6a2c48u);
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const std::uint32_t v = random.bits();
        EXPECT_EQ(detail::reverse_bits(detail::reverse_bits(v)), v);
    }
}

/// Bit i of an Owen-scrambled number depends on the bits above it only (below it, reversed).
TEST(ScrambleReversed, IsNestedAndOneToOne) {
    Random random(2);
    for (int i = 0; i < 2000; ++i) {
        const std::uint32_t seed = random.bits(), a = random.bits();
        const std::uint32_t bit = random.index(32);
        const std::uint32_t b = a ^ (1u << bit);
        const std::uint32_t difference =
            detail::scramble_reversed(a, seed) ^ detail::scramble_reversed(b, seed);
        EXPECT_EQ(difference & ((1u << bit) - 1), 0u); // lower bits untouched
        EXPECT_NE(difference & (1u << bit), 0u);       // this one flips with its input
    }
}

/// Sobol': n = 2^k samples have one value in each interval of 1/n, in every dimension of every
/// group, from any multiple of n on.
TEST(SobolSampler, PutsOnePointIntoEachIntervalOfEveryDimension) {
    for (const std::uint32_t group : {0u, 1u, 2u, 3u, 10u, 37u})
        for (const std::uint32_t pixel : {0u, 77u, 4000000u})
            for (const std::uint32_t n : {1u, 2u, 16u, 64u, 1024u})
                for (const std::uint32_t block : {0u, 3u, 65536u / n})
                    for (int d = 0; d < 4; ++d) {
                        std::vector<int> strata(n);
                        for (std::uint32_t i = 0; i < n; ++i) {
                            const Sampler sampler(SamplerKind::sobol, 5, pixel, block * n + i);
                            const float x = sampler.group(group).x[d];
                            ++strata[static_cast<std::size_t>(x * static_cast<float>(n))];
                        }
                        ASSERT_TRUE(one_each(strata))
                            << group << ' ' << pixel << ' ' << n << ' ' << block << ' ' << d;
                    }
}

/// The first two dimensions of a group are a (0,2)-sequence: one point in every elementary box of
/// area 1/n, whatever its shape.
TEST(SobolSampler, PutsOnePointIntoEachElementaryBoxOfTheFirstTwoDimensions) {
    for (const std::uint32_t group : {0u, 1u, 2u, 5u, 22u})
        for (const std::uint32_t pixel : {0u, 123456u})
            for (const int k : {1, 4, 6, 8, 10}) {
                const std::uint32_t n = 1u << k;
                for (int a = 0; a <= k; ++a) {
                    std::vector<int> boxes(n);
                    for (std::uint32_t i = 0; i < n; ++i) {
                        const Sample4 s = Sampler(SamplerKind::sobol, 9, pixel, i).group(group);
                        const auto x = static_cast<std::uint32_t>(std::ldexp(s.x[0], a));
                        const auto y = static_cast<std::uint32_t>(std::ldexp(s.x[1], k - a));
                        ++boxes[(x << (k - a)) + y];
                    }
                    ASSERT_TRUE(one_each(boxes)) << group << ' ' << pixel << ' ' << n << ' ' << a;
                }
            }
}

TEST(Sampler, IsInTheHalfOpenUnitInterval) {
    Random random(3);
    for (const SamplerKind kind : kinds)
        for (int i = 0; i < 500000; ++i) {
            const std::uint64_t seed = (std::uint64_t{random.bits()} << 32) | random.bits();
            for (const float x :
                 Sampler(kind, seed, random.bits(), random.bits()).group(random.index(100)).x) {
                ASSERT_GE(x, 0.0f);
                ASSERT_LT(x, 1.0f);
            }
        }
}

/// The same numbers again, whatever was asked in between and in which order.
TEST(Sampler, IsAPureFunctionOfItsArguments) {
    for (const SamplerKind kind : kinds) {
        const Sampler one(kind, 42, 7, 3);
        std::vector<float> forwards, backwards;
        for (std::uint32_t g = 0; g < 20; ++g)
            for (const float x : one.group(g).x)
                forwards.push_back(x);
        for (std::uint32_t g = 20; g-- > 0;) {
            const Sampler again(kind, 42, 7, 3);
            const Sample4 s = again.group(g);
            for (int d = 3; d >= 0; --d)
                backwards.push_back(s.x[d]);
        }
        std::reverse(backwards.begin(), backwards.end());
        EXPECT_EQ(forwards, backwards);
    }
}

/// Every argument counts, the upper half of the seed included.
TEST(Sampler, ChangesWithEveryArgument) {
    for (const SamplerKind kind : kinds) {
        const auto first = [&](std::uint64_t seed, std::uint32_t pixel, std::uint32_t sample,
                               std::uint32_t group) {
            const Sample4 s = Sampler(kind, seed, pixel, sample).group(group);
            return std::vector<float>(std::begin(s.x), std::end(s.x));
        };
        std::set<std::vector<float>> all;
        std::size_t count = 0;
        for (const std::uint64_t seed : {0ull, 1ull, 1ull << 32, 1ull << 63, (1ull << 32) + 1})
            for (const std::uint32_t pixel : {0u, 1u, 2u, 512u, 1u << 30})
                for (const std::uint32_t sample : {0u, 1u, 2u, 255u, 65536u, 0x80000000u})
                    for (const std::uint32_t group : {0u, 1u, 2u, 9u}) {
                        all.insert(first(seed, pixel, sample, group));
                        ++count;
                    }
        EXPECT_EQ(all.size(), count);
    }
}

} // namespace
} // namespace plumb::test
