/// \file  Importance sampling of the reconstruction filters, against the filters themselves.

#include "renderer/sampling/film_filter.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace plumb::test {
namespace {

/// The filter as its definition has it, not normalized, and its half width; x in pixels.
struct Reference {
    std::function<double(double)> value;
    double radius;
};

/// Mitchell and Netravali 1988, the cubic in the paper's own form.
double mitchell_netravali(double x, double b, double c) {
    const double a = std::fabs(x);
    const double p3 = a < 1 ? 12 - 9 * b - 6 * c : -b - 6 * c;
    const double p2 = a < 1 ? -18 + 12 * b + 6 * c : 6 * b + 30 * c;
    const double p1 = a < 1 ? 0 : -12 * b - 48 * c;
    const double p0 = a < 1 ? 6 - 2 * b : 8 * b + 24 * c;
    return a < 2 ? (((p3 * a + p2) * a + p1) * a + p0) / 6 : 0;
}

Reference reference(const Filter& f) {
    const double r = static_cast<double>(f.radius), s = static_cast<double>(f.stddev);
    const double b = static_cast<double>(f.b), c = static_cast<double>(f.c);
    switch (f.kind) {
    case FilterKind::box: return {[](double) { return 1.0; }, 0.5};
    case FilterKind::tent: return {[r](double x) { return 1 - std::fabs(x) / r; }, r};
    case FilterKind::gaussian:
        return {[s](double x) { return std::exp(-x * x / (2 * s * s)) - std::exp(-8.0); }, 4 * s};
    case FilterKind::mitchell: return {[b, c](double x) { return mitchell_netravali(x, b, c); }, 2};
    }
    return {};
}

double integral(const std::function<double(double)>& f, double low, double high) {
    const int steps = 64; // midpoint rule
    double sum = 0;
    for (int i = 0; i < steps; ++i)
        sum += f(low + (high - low) * (i + 0.5) / steps);
    return sum * (high - low) / steps;
}

struct Named {
    std::string name;
    Filter filter;
};

Filter make(FilterKind kind, float radius, float stddev, float b, float c) {
    return {kind, radius, stddev, b, c};
}

const std::vector<Named>& filters() {
    const float third = 1.0f / 3;
    static const std::vector<Named> all{
        {"box", make(FilterKind::box, 1, 0.5f, third, third)},
        {"tent1", make(FilterKind::tent, 1, 0.5f, third, third)},
        {"tent2_5", make(FilterKind::tent, 2.5f, 0.5f, third, third)},
        {"gaussian0_5", make(FilterKind::gaussian, 1, 0.5f, third, third)},
        {"gaussian0_2", make(FilterKind::gaussian, 1, 0.2f, third, third)},
        {"gaussian1_3", make(FilterKind::gaussian, 1, 1.3f, third, third)},
        {"mitchell", make(FilterKind::mitchell, 1, 0.5f, third, third)},
        {"b_spline", make(FilterKind::mitchell, 1, 0.5f, 1, 0)},
        {"catmull_rom", make(FilterKind::mitchell, 1, 0.5f, 0, 0.5f)},
        {"robidoux", make(FilterKind::mitchell, 1, 0.5f, 0.3782f, 0.3109f)},
    };
    return all;
}

class FilterSampling : public ::testing::TestWithParam<std::size_t> {
  protected:
    [[nodiscard]] const Filter& filter() const { return filters()[GetParam()].filter; }
    FilterTable table_ = make_filter_table(filter());
    Reference exact_ = reference(filter());
};

/// Counts of offsets against |filter|, and sums of weights against the filter.
TEST_P(FilterSampling, HasTheDensityOfTheFilter) {
    const int bins = 64;
    const int n = 500000;
    const double r = exact_.radius, width = 2 * r / bins;
    std::vector<double> counts(bins), weighted(bins), expected, share;
    Random random(1);
    for (int i = 0; i < n; ++i) {
        const FilterSample s = sample_filter(table_, random.uniform());
        const double x = static_cast<double>(s.offset);
        ASSERT_LE(std::fabs(x), r * (1 + 1e-6));
        const auto bin =
            static_cast<std::size_t>(std::clamp(static_cast<int>((x + r) / width), 0, bins - 1));
        counts[bin] += 1;
        weighted[bin] += static_cast<double>(s.weight) / n;
    }
    const auto magnitude = [&](double x) { return std::fabs(exact_.value(x)); };
    double total = 0, signed_total = 0;
    for (int i = 0; i < bins; ++i) {
        expected.push_back(integral(magnitude, -r + i * width, -r + (i + 1) * width));
        share.push_back(integral(exact_.value, -r + i * width, -r + (i + 1) * width));
        total += expected.back();
        signed_total += share.back();
    }
    for (double& e : expected)
        e *= n / total;
    EXPECT_GT(chi_square_p_value(counts, expected), p_limit);
    for (std::size_t i = 0; i < counts.size(); ++i) { // the sign and size of the weights
        const double wanted = share[i] / signed_total;
        const double p = expected[i] / n, scale = total / signed_total;
        EXPECT_NEAR(weighted[i], wanted, 6 * scale * std::sqrt(p / n) + 1e-4 * p) << i;
    }
}

/// corrections.md, jitter: a constant image stays constant ...
TEST_P(FilterSampling, LeavesAConstantImageConstant) {
    double sum = 0;
    const int n = 1 << 20;
    for (int i = 0; i < n; ++i) // every stratum once: no noise
        sum += static_cast<double>(
            sample_filter(table_, (static_cast<float>(i) + 0.5f) / static_cast<float>(n)).weight);
    EXPECT_NEAR(sum / n, 1, 2e-5);
    Random random(2);
    MeanTest mean;
    for (int i = 0; i < 200000; ++i)
        mean.add(static_cast<double>(sample_filter(table_, random.uniform()).weight));
    EXPECT_LE(std::fabs(mean.z(1)), z_limit);
}

/// ... and a ramp stays a ramp: the mean of (c + offset) under the filter is c at every pixel.
TEST_P(FilterSampling, LeavesARampARamp) {
    double sum = 0;
    const int n = 1 << 20;
    for (int i = 0; i < n; ++i) {
        const FilterSample s =
            sample_filter(table_, (static_cast<float>(i) + 0.5f) / static_cast<float>(n));
        sum += static_cast<double>(s.weight) * static_cast<double>(s.offset);
    }
    EXPECT_NEAR(sum / n, 0, 2e-5 * exact_.radius);
    Random random(3);
    MeanTest mean;
    for (int i = 0; i < 200000; ++i) {
        const FilterSample s = sample_filter(table_, random.uniform());
        mean.add(static_cast<double>(s.weight) * static_cast<double>(s.offset));
    }
    EXPECT_LE(std::fabs(mean.z(0)), z_limit);
}

TEST_P(FilterSampling, IsFiniteAndInsideAtTheEnds) {
    for (const float u : {0.0f, unit_roundoff, 0.5f, 1 - unit_roundoff}) {
        const FilterSample s = sample_filter(table_, u);
        EXPECT_LE(std::fabs(s.offset), static_cast<float>(exact_.radius)) << u;
        EXPECT_TRUE(std::isfinite(s.weight)) << u;
    }
}

/// A monotone map keeps the strata of the sampler.
TEST_P(FilterSampling, IsMonotone) {
    float before = -static_cast<float>(exact_.radius);
    for (int i = 0; i < 100000; ++i) {
        const float offset =
            sample_filter(table_, (static_cast<float>(i) + 0.5f) / 100000.0f).offset;
        ASSERT_GE(offset, before) << i;
        before = offset;
    }
}

INSTANTIATE_TEST_SUITE_P(All, FilterSampling, ::testing::Range<std::size_t>(0, 10),
                         [](const auto& tested) { return filters()[tested.param].name; });

/// Positive filters need no weights: one sample, one pixel, weight one.
TEST(FilterTable, GivesPositiveFiltersUnitWeights) {
    for (const Named& f : filters()) {
        const bool signs = f.name == "mitchell" || f.name == "catmull_rom" || f.name == "robidoux";
        const FilterTable table = make_filter_table(f.filter);
        float low = 2, high = -2;
        for (int i = 0; i < 4096; ++i) {
            const float w = sample_filter(table, (static_cast<float>(i) + 0.5f) / 4096).weight;
            low = std::min(low, w);
            high = std::max(high, w);
        }
        if (signs) {
            EXPECT_FLOAT_EQ(low, -high) << f.name;
            EXPECT_GT(high, 1) << f.name;
        } else {
            EXPECT_FLOAT_EQ(low, 1) << f.name;
            EXPECT_FLOAT_EQ(high, 1) << f.name;
        }
    }
}

} // namespace
} // namespace plumb::test
