/// \file  The film's sums, variances and crop.

#include "renderer/integrate/film.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace plumb::test {
namespace {

Rgb grey(float x) { return {x, 2 * x, 4 * x}; }

/// stability.md, float accumulation: 66 % of 1e8 samples of U[0,1] are lost in float. 2^24 ones are
/// where a float sum stops; here the sum goes on to five times as many.
TEST(FilmPixel, AddsEightyMillionSamplesWithoutLoss) {
    FilmPixel pixel;
    const std::uint32_t n = 80'000'000;
    float in_float = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        pixel.add({1, 0.1f, 0.5f}, false);
        in_float += 1;
    }
    EXPECT_EQ(in_float, 0x1p24f); // what the test is about
    EXPECT_EQ(pixel.count, n);
    EXPECT_EQ(pixel.sum[0], static_cast<double>(n));
    const double exact = static_cast<double>(n) * static_cast<double>(0.1f);
    EXPECT_LT(std::fabs(pixel.sum[1] / exact - 1), 1e-8);
    EXPECT_EQ(pixel.sum[2], 0.5 * static_cast<double>(n));
}

/// Random samples against a sum in extended precision.
TEST(FilmPixel, SumsToWithinOnePartInATrillion) {
    FilmPixel pixel;
    Random random(1);
    long double exact = 0;
    for (int i = 0; i < 5'000'000; ++i) {
        const float x = random.uniform();
        exact += static_cast<long double>(x);
        pixel.add(grey(x), false);
    }
    const double wanted = static_cast<double>(exact);
    EXPECT_LT(std::fabs(pixel.sum[0] / wanted - 1), 1e-12);
    EXPECT_LT(std::fabs(pixel.sum[2] / (4 * wanted) - 1), 1e-12);
}

/// stability.md: E[x²] - E[x]² in float at a mean of 1000 gives -23,592 where 1/12 is true.
TEST(FilmPixel, KeepsTheVarianceOfSamplesAroundAThousand) {
    FilmPixel pixel;
    Random random(2);
    const int n = 1'000'000;
    for (int i = 0; i < n; ++i) {
        const float x = random.uniform();
        pixel.add({1000 + x, x, 1e6f + x}, true);
    }
    EXPECT_NEAR(pixel.m2[0] / (n - 1) * 12, 1, 0.01);
    EXPECT_NEAR(pixel.m2[1] / (n - 1) * 12, 1, 0.01);
    EXPECT_NEAR(pixel.m2[2] / (n - 1) * 12, 1, 0.02); // x is rounded to 1/16 there
}

/// corrections.md, the Monte Carlo sum: all N samples, divided by N; N - 1 belongs to the variance.
TEST(Film, MeansAreOverAllSamplesAndVariancesOverOneLess) {
    Film film(2, 1, {0, 0, 2, 1}, true);
    film.pixel(0, 0).add(grey(3), true);
    for (const float x : {1.0f, 2.0f, 4.0f, 9.0f})
        film.pixel(1, 0).add(grey(x), true);
    const Image image = film.resolve();
    EXPECT_EQ(image.pixels[0], grey(3)); // one sample: itself, not zero
    EXPECT_EQ(image.pixels[1], grey(4)); // not 3/4 of it
    EXPECT_EQ(image.variance[0], (Rgb{0, 0, 0}));
    const float variance = (9 + 4 + 0 + 25) / 3.0f;
    EXPECT_FLOAT_EQ(image.variance[1].r, variance);
    EXPECT_FLOAT_EQ(image.variance[1].g, 4 * variance);
    EXPECT_FLOAT_EQ(image.variance[1].b, 16 * variance);
}

/// The variance of the mean of n = 4 is unbiased: over many groups its mean is the true one.
TEST(Film, VarianceIsUnbiasedForFewSamples) {
    Random random(3);
    double sum = 0;
    const int groups = 200'000;
    for (int g = 0; g < groups; ++g) {
        FilmPixel pixel;
        for (int i = 0; i < 4; ++i)
            pixel.add({random.uniform(), 0, 0}, true);
        sum += pixel.m2[0] / 3;
    }
    EXPECT_NEAR(sum / groups, 1.0 / 12, 5 * 0.055 / std::sqrt(static_cast<double>(groups)));
}

TEST(Film, KeepsACropInItsPlaceInTheFullFilm) {
    Film film(100, 50, {10, 20, 3, 2}, false);
    for (int y = 20; y < 22; ++y)
        for (int x = 10; x < 13; ++x)
            film.pixel(x, y).add({static_cast<float>(x), static_cast<float>(y), 1}, false);
    const Image image = film.resolve();
    EXPECT_EQ(image.width, 3);
    EXPECT_EQ(image.height, 2);
    EXPECT_EQ(image.full_width, 100);
    EXPECT_EQ(image.full_height, 50);
    EXPECT_EQ(image.offset_x, 10);
    EXPECT_EQ(image.offset_y, 20);
    ASSERT_EQ(image.pixels.size(), 6u);
    EXPECT_EQ(image.pixels[0], (Rgb{10, 20, 1}));
    EXPECT_EQ(image.pixels[2], (Rgb{12, 20, 1}));
    EXPECT_EQ(image.pixels[3], (Rgb{10, 21, 1})); // row by row from the top left
    EXPECT_TRUE(image.variance.empty());
    EXPECT_EQ(film.bytes(), 6 * sizeof(FilmPixel));
}

TEST(Film, PixelsWithoutSamplesAreBlack) {
    const Image image = Film(1, 1, {0, 0, 1, 1}, true).resolve();
    EXPECT_EQ(image.pixels[0], Rgb{});
    EXPECT_EQ(image.variance[0], Rgb{});
}

TEST(Film, TheMeanDoesNotDependOnWhetherVarianceIsKept) {
    Film with(1, 1, {0, 0, 1, 1}, true), without(1, 1, {0, 0, 1, 1}, false);
    Random random(4);
    for (int i = 0; i < 1000; ++i) {
        const Rgb x = grey(random.uniform());
        with.pixel(0, 0).add(x, true);
        without.pixel(0, 0).add(x, false);
    }
    EXPECT_EQ(with.resolve().pixels[0], without.resolve().pixels[0]);
}

} // namespace
} // namespace plumb::test
