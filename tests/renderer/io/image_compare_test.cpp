/// \file  Error measures against numbers by hand, z-tests against the rates that their level
/// promises.
#include "renderer/io/compare_images.h"

#include "renderer/scene/error.h"
#include "tests/support/random.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace plumb {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Image flat(int width, int height, Rgb colour) {
    return {width,
            height,
            width,
            height,
            0,
            0,
            std::vector<Rgb>(static_cast<std::size_t>(width * height), colour),
            {}};
}

/// A normal deviate (Box and Muller).
float normal(test::Random& random) {
    const double radius = std::sqrt(-2 * std::log(1 - random.uniform_double()));
    return static_cast<float>(radius * std::cos(6.283185307179586 * random.uniform_double()));
}

/// Mean of `spp` normal samples around 0.5 * scale with standard deviation 1, and its variance.
Image noisy(std::uint64_t seed, double spp, float scale = 1) {
    Image image = flat(48, 48, {});
    image.variance.assign(image.pixels.size(), {1, 1, 1});
    test::Random random(seed);
    const auto sigma = static_cast<float>(1 / std::sqrt(spp));
    for (Rgb& c : image.pixels) {
        const float r = normal(random), g = normal(random);
        c = Rgb{0.5f, 0.5f, 0.5f} * scale + Rgb{r, g, normal(random)} * sigma;
    }
    return image;
}

TEST(CompareImages, MeasuresOfASmallImageAreTheOnesByHand) {
    Image a = flat(2, 1, {1, 2, 3}), b = a;
    a.pixels[1] = {1, 2, 5}; // one of six values differs, by 2, where b is 3
    const ImageComparison c = compare(a, b);
    EXPECT_DOUBLE_EQ(c.mse, 4.0 / 6);
    EXPECT_DOUBLE_EQ(c.rel_mse, 4.0 / 9.01 / 6);
    EXPECT_DOUBLE_EQ(c.psnr_db, 10 * std::log10(6.0 / 4));
    EXPECT_DOUBLE_EQ(c.max_abs, 2);
    EXPECT_EQ(c.max_x, 1);
    EXPECT_EQ(c.max_y, 0);
    EXPECT_DOUBLE_EQ(c.mean_a[2], 4);
    EXPECT_DOUBLE_EQ(c.mean_b[2], 3);
    EXPECT_DOUBLE_EQ(c.mean_ratio(2), 4.0 / 3);
    EXPECT_DOUBLE_EQ(c.mean_error(), 4.0 / 3 - 1);
    EXPECT_EQ(c.different_bits, 1u);
    EXPECT_EQ(c.values, 6u);
    EXPECT_EQ(c.mean_z[0], 0);
    EXPECT_DOUBLE_EQ(c.mean_z[2], 1); // differences 0 and 2: mean 1, standard error 1
}

TEST(CompareImages, EqualImagesHaveNoDifferenceAndInfinitePsnr) {
    const Image a = flat(3, 3, {0.2f, 0, 7});
    const ImageComparison c = compare(a, a);
    EXPECT_EQ(c.mse, 0);
    EXPECT_EQ(c.psnr_db, std::numeric_limits<double>::infinity());
    EXPECT_EQ(c.different_bits, 0u);
    EXPECT_EQ(c.mean_ratio(1), 1);
}

TEST(CompareImages, ValuesThatAreNotFiniteAreCountedAndLeftOut) {
    Image a = flat(2, 2, {1, 1, 1}), b = a;
    a.pixels[0].r = nan;
    b.pixels[1].g = infinity;
    a.pixels[2].b = b.pixels[2].b = infinity; // the same in both: no difference
    const ImageComparison c = compare(a, b);
    EXPECT_EQ(c.non_finite, 2u);
    EXPECT_EQ(c.values, 9u);
    EXPECT_EQ(c.mse, 0);
}

TEST(CompareImages, SizesThatDifferAreAnErrorThatNamesThem) {
    try {
        static_cast<void>(compare(flat(2, 3, {}), flat(3, 2, {})));
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_STREQ(error.what(), "error: the images differ in size: 2x3 and 3x2");
    }
}

TEST(ZTestOfImages, PassesForEqualExpectationsAtTheRateOfItsLevel) {
    // 300 pairs at level 0.05 each: 15 failures expected, standard deviation 3.8; 4.75 of those.
    int pixel_failures = 0, mean_failures = 0;
    for (std::uint64_t pair = 0; pair < 300; ++pair) {
        const ZTest t = z_test(noisy(2 * pair, 16), 16, noisy(2 * pair + 1, 64), 64, 0.05);
        pixel_failures += t.pixels_pass() ? 0 : 1;
        mean_failures += t.mean_passes() ? 0 : 1;
    }
    EXPECT_GE(pixel_failures, 1);
    EXPECT_LE(pixel_failures, 33);
    EXPECT_GE(mean_failures, 1);
    EXPECT_LE(mean_failures, 33);
}

TEST(ZTestOfImages, TestOfTheMeanSeesABiasThatNoPixelShows) {
    const Image a = noisy(1, 16, 1.05f), b = noisy(2, 16); // 0.025 of bias, 0.25 of noise
    const ZTest t = z_test(a, 16, b, 16);
    EXPECT_TRUE(t.pixels_pass());
    EXPECT_FALSE(t.mean_passes());
    // 48² pixels: the standard error of a mean's difference is sqrt(2 / 16) / 48.
    EXPECT_NEAR(t.mean_z[0], 0.025 / (std::sqrt(2.0 / 16) / 48), 4.75);
}

TEST(CompareImages, PairedTestOfTheMeanAgreesWithTheOneByVariance) {
    const Image a = noisy(1, 16, 1.05f), b = noisy(2, 16);
    const ImageComparison c = compare(a, b);
    const ZTest t = z_test(a, 16, b, 16);
    for (std::size_t channel = 0; channel < 3;
         ++channel) // noise of the variance: 1 / sqrt(2 * 48²)
        EXPECT_NEAR(c.mean_z[channel] / t.mean_z[channel], 1, 4.75 / (48 * std::sqrt(2.0)) / 2);
}

TEST(ZTestOfImages, TestOfPixelsSeesOneWrongPixel) {
    Image a = noisy(1, 16);
    const Image b = noisy(2, 16);
    a.pixels[48 * 10 + 7].g += 3; // 8.5 standard deviations of the difference
    const ZTest t = z_test(a, 16, b, 16);
    EXPECT_EQ(t.failed, 1u);
    EXPECT_EQ(t.largest_x, 7);
    EXPECT_EQ(t.largest_y, 10);
    EXPECT_EQ(t.tests, 48u * 48 * 3);
    EXPECT_TRUE(t.mean_passes());
}

TEST(ZTestOfImages, OneVarianceServesBothAndAnExactImageHasNone) {
    const Image a = noisy(1, 16);
    Image b = noisy(2, 16);
    b.variance.clear();
    EXPECT_TRUE(z_test(a, 16, b, 16).passes());
    const Image exact = flat(48, 48, {0.5f, 0.5f, 0.5f});
    EXPECT_TRUE(z_test(a, 16, exact, std::numeric_limits<double>::infinity()).passes());
    // Claiming 16 times the samples quarters the noise that is expected: it must show.
    EXPECT_FALSE(z_test(a, 256, exact, std::numeric_limits<double>::infinity()).passes());
}

TEST(ZTestOfImages, NoiselessPixelsMayDifferByTheRoundingOfAHalfOnly) {
    Image a = flat(4, 4, {1, 1, 1});
    a.variance.assign(16, {});
    Image b = flat(4, 4, {1 + 0x1p-12f, 1, 1});
    EXPECT_TRUE(z_test(a, 4, b, 4).pixels_pass());
    b.pixels[5].b = 1.002f;
    EXPECT_EQ(z_test(a, 4, b, 4).failed, 1u);
    b = flat(4, 4, {1, 1, 1});
    a.pixels[0] = {};
    b.pixels[0] = {1e-30f, 0, 0}; // less than half of the smallest half
    EXPECT_EQ(z_test(a, 4, b, 4).failed, 0u);
}

TEST(ZTestOfImages, NanFailsWhateverTheNoise) {
    Image a = noisy(1, 16);
    a.pixels[3].r = nan;
    EXPECT_EQ(z_test(a, 16, noisy(2, 16), 16).failed, 1u);
    Image c = noisy(1, 16);
    c.variance[3].r = nan;
    EXPECT_GE(z_test(c, 16, noisy(2, 16), 16).failed, 1u);
}

TEST(ZTestOfImages, NeedsVarianceAndSamples) {
    const Image bare = flat(2, 2, {});
    EXPECT_THROW(static_cast<void>(z_test(bare, 1, bare, 1)), SceneError);
    Image a = bare;
    a.variance.assign(4, {1, 1, 1});
    EXPECT_THROW(static_cast<void>(z_test(a, 0, bare, 1)), SceneError);
    EXPECT_NO_THROW(static_cast<void>(z_test(a, 1, bare, 1)));
}

} // namespace
} // namespace plumb
