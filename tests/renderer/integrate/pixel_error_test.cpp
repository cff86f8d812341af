/// \file  The relative error of pixels and images: formulas by hand, and coverage by simulation.

#include "renderer/integrate/pixel_error.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace plumb::test {
namespace {

FilmPixel pixel_of(std::initializer_list<Rgb> samples) {
    FilmPixel pixel;
    for (const Rgb& sample : samples)
        pixel.add(sample, true);
    return pixel;
}

Rgb grey(float x) { return {x, x, x}; }

TEST(PixelError, IsHalfTheConfidenceIntervalOverTheMean) {
    // 1, 2, 3, 6: mean 3, variance (4 + 1 + 0 + 9) / 3.
    const FilmPixel pixel = pixel_of({grey(1), grey(2), grey(3), grey(6)});
    EXPECT_NEAR(mean_luminance(pixel), 3, 1e-12);
    const double half_width = 1.959963984540054 * std::sqrt(14.0 / 3);
    EXPECT_NEAR(relative_error(pixel, 4, 0), half_width / std::sqrt(4.0) / 3, 1e-12);
    EXPECT_NEAR(relative_error(pixel, 100, 0), half_width / std::sqrt(100.0) / 3, 1e-12);
    EXPECT_NEAR(relative_error(pixel, 4, 2.9), relative_error(pixel, 4, 0), 1e-12);
    EXPECT_NEAR(relative_error(pixel, 4, 5), half_width / std::sqrt(4.0) / 5, 1e-12);
}

TEST(PixelError, IsUnknownForOneSampleAndNothingWithoutVariance) {
    EXPECT_EQ(relative_error(pixel_of({grey(1)}), 1, 1), std::numeric_limits<double>::infinity());
    EXPECT_EQ(relative_error({}, 0, 1), std::numeric_limits<double>::infinity());
    EXPECT_EQ(relative_error(pixel_of({grey(2), grey(2)}), 2, 0), 0);
    EXPECT_EQ(relative_error(pixel_of({grey(0), grey(0)}), 2, 0), 0); // 0 / 0 is no NaN
}

TEST(PixelError, IsNotBelowThatOfTheLuminance) {
    Random random(1);
    FilmPixel pixel, luminances;
    for (int i = 0; i < 1000; ++i) {
        const Rgb sample{random.uniform(), random.uniform(), random.uniform()};
        pixel.add(sample, true);
        luminances.add(grey(luminance(sample)), true);
    }
    EXPECT_GE(relative_error(pixel, 1000, 0), relative_error(luminances, 1000, 0));
    EXPECT_LE(relative_error(pixel, 1000, 0), 1.5 * relative_error(luminances, 1000, 0));
}

TEST(PixelError, HoldsForNineteenOfTwentyPixels) {
    Random random(2);
    int within = 0;
    constexpr int trials = 20'000, n = 200;
    for (int t = 0; t < trials; ++t) {
        FilmPixel pixel;
        for (int i = 0; i < n; ++i)
            pixel.add(grey(random.uniform()), true);
        const double mean = mean_luminance(pixel);
        within += std::fabs(mean - 0.5) <= relative_error(pixel, n, 0) * mean ? 1 : 0;
    }
    EXPECT_NEAR(within / double{trials}, 0.95, 0.01);
}

TEST(ErrorOfImage, IsThatOfTheWorstPixelButOneInAHundred) {
    std::vector<float> errors(200, 0.5f);
    errors[7] = errors[150] = 9;
    EXPECT_EQ(error_of_image(errors), 0.5);
    errors[20] = 3;
    EXPECT_EQ(error_of_image(errors), 3);
    EXPECT_EQ(error_of_image(std::vector<float>{2, 1}), 2);
    EXPECT_EQ(error_of_image(std::span<const float>()), std::numeric_limits<double>::infinity());
}

TEST(ErrorOfImage, ReckonsDarkPixelsAgainstATenthOfTheImagesMean) {
    const FilmPixel bright = pixel_of({grey(10), grey(10)});
    const FilmPixel dark = pixel_of({grey(0), grey(0.2f)}); // mean 0.1, variance 0.02
    const std::vector<FilmPixel> pixels{bright, dark};      // mean 5.05
    EXPECT_NEAR(error_of_image(pixels), 1.959963984540054 * std::sqrt(0.02 / 2) / 0.505, 1e-6);
}

TEST(MeanOfHalves, GivesEachHalfOneHalf) {
    const FilmPixel a = pixel_of({grey(1), grey(3)}), b = pixel_of({grey(5), grey(6), grey(13)});
    const FilmPixel mean = mean_of_halves(a, b);
    EXPECT_EQ(mean.count, 5u);
    EXPECT_NEAR(mean.sum[1] / 5, (2 + 8) / 2.0, 1e-12); // not 28 / 5
    // Pooled variance (2 + 38) / 3; of the mean: that times (1/2 + 1/3) / 4.
    EXPECT_NEAR(mean.m2[1] / 4 / 5, 40.0 / 3 * (5.0 / 6) / 4, 1e-12);
    const FilmPixel same = mean_of_halves(a, pixel_of({grey(5), grey(8)}));
    EXPECT_EQ(same.sum[0], 17);
    EXPECT_NEAR(same.m2[0] / 3 / 4, (2 + 4.5) / 2 / 4, 1e-12);
    EXPECT_EQ(mean_of_halves(a, {}).sum[0], 4);
    EXPECT_EQ(mean_of_halves({}, a).count, 2u);
    EXPECT_EQ(mean_of_halves({}, {}).count, 0u);
}

} // namespace
} // namespace plumb::test
