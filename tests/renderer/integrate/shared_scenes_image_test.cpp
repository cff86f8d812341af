/// \file  Scenes with reference images by other renderers, where they lie beside the project.
///
/// Pixels are tested one by one against Mitsuba and, away from edges, where its filter is another,
/// against Tungsten; blocks of pixels over all of its image.
///
/// A pixel's z is not normal where rare bright paths make its samples skewed: mean and sample
/// variance are both too low where such a path is missing, and the ratio has a long lower tail.
/// With its own variance alone, 41 of 196,608 pixel channels of the box at 256 samples lie beyond
/// the limit of 5.45, one at z = -15.7. See steadied().
#include "tests/support/render_scene.h"
#include "tests/support/shared_scene.h"

#include "renderer/io/compare_images.h"
#include "renderer/io/read_image.h"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <limits>
#include <optional>

namespace plumb::test {
namespace {

constexpr double noiseless = std::numeric_limits<double>::infinity();

/// Means of size x size pixels. Variance: of one sample of a block, spp being those of a pixel.
Image in_blocks(const Image& image, int size) {
    Image blocks;
    blocks.width = blocks.full_width = image.width / size;
    blocks.height = blocks.full_height = image.height / size;
    const auto count = static_cast<std::size_t>(blocks.width * blocks.height);
    const float share = 1 / static_cast<float>(size * size);
    blocks.pixels.resize(count);
    if (!image.variance.empty())
        blocks.variance.resize(count);
    for (int y = 0; y < blocks.height * size; ++y)
        for (int x = 0; x < blocks.width * size; ++x) {
            const auto from = static_cast<std::size_t>(y * image.width + x);
            const auto to = static_cast<std::size_t>(y / size * blocks.width + x / size);
            blocks.pixels[to] += image.pixels[from] * share;
            if (!image.variance.empty())
                blocks.variance[to] += image.variance[from] * (share * share);
        }
    return blocks;
}

/// The image with the variance of each pixel raised two thirds of the way to the mean of its eight
/// neighbours', where that is more. To first order in skewness / sqrt(spp), the skewness of
/// (mean - expectation) / sqrt(w own + (1 - w) neighbours') is that of a mean times 1 - 3 w: with
/// w = 1/3 the missing paths of a pixel no longer count twice. Raising only makes the test milder.
Image steadied(const Image& image) {
    Image result = image;
    const auto at = [&image](int x, int y) {
        return image.variance[static_cast<std::size_t>(y * image.width + x)];
    };
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            Rgb around = at(x, y) * -1;
            float count = -1;
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, image.height - 1); ++j)
                for (int i = std::max(x - 1, 0); i <= std::min(x + 1, image.width - 1); ++i) {
                    around += at(i, j);
                    ++count;
                }
            const auto raised = [count](float own, float sum) {
                return own + std::max(sum / count - own, 0.0f) * (2.0f / 3);
            };
            const Rgb own = at(x, y);
            result.variance[static_cast<std::size_t>(y * image.width + x)] = {
                raised(own.r, around.r), raised(own.g, around.g), raised(own.b, around.b)};
        }
    return result;
}

/// `image`, which is the crop of `expected` at (x0, y0), with the pixels of `expected` itself where
/// an edge is near: some pixel within two of it is half as bright again as another.
Image without_edges(Image image, const Image& expected, int x0, int y0) {
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const auto at = [&](int i, int j) {
                return expected.pixels.at(
                    static_cast<std::size_t>((y0 + y + j) * expected.width + x0 + x + i));
            };
            Rgb low = at(0, 0), high = low;
            for (int j = -2; j <= 2; ++j)
                for (int i = -2; i <= 2; ++i) {
                    const Rgb p = at(i, j);
                    low = {std::min(low.r, p.r), std::min(low.g, p.g), std::min(low.b, p.b)};
                    high = {std::max(high.r, p.r), std::max(high.g, p.g), std::max(high.b, p.b)};
                }
            if (high.r > 1.5f * low.r || high.g > 1.5f * low.g || high.b > 1.5f * low.b)
                image.pixels[static_cast<std::size_t>(y * image.width + x)] = at(0, 0);
        }
    return image;
}

/// The part of an image that a render of `crop` is compared with.
Image cropped(const Image& image, const Crop& crop) {
    Image part;
    part.width = part.full_width = crop.width;
    part.height = part.full_height = crop.height;
    for (int y = 0; y < crop.height; ++y)
        for (int x = 0; x < crop.width; ++x)
            part.pixels.push_back(
                image.pixels.at(static_cast<std::size_t>((crop.y + y) * image.width + crop.x + x)));
    return part;
}

/// What a scene is held to.
struct Limits {
    double mean_error;    ///< relative, of the image mean of each channel
    int block;            ///< pixels; 1: every pixel by itself
    double reference_spp; ///< samples in a pixel of the reference, for its noise
};

class SharedScenes : public ::testing::Test {
  protected:
    /// Skips the test visibly where the scene is not there.
    void find(const std::string& scene) {
        const auto folder = unpacked_scene(PLUMB_SOURCE_DIR "/../shared/scenes", scene,
                                           PLUMB_BINARY_DIR "/shared-scenes");
        if (!folder)
            GTEST_SKIP() << "no archive of the scene '" << scene << "' beside the project";
        folder_ = *folder;
    }
    [[nodiscard]] Image reference(const char* file) const { return read_image(folder_ / file); }

    /// Independent samples, for the z-tests.
    [[nodiscard]] Image rendered(const char* file, std::uint32_t spp,
                                 std::optional<Crop> crop = {}) const {
        RenderSetup setup;
        setup.variance = true;
        setup.threads = 0;
        setup.adjust = [spp, crop](Scene& scene) {
            scene.sampler = {SamplerKind::independent, spp, 1};
            scene.film.crop = crop.value_or(scene.film.crop);
        };
        return render_file(folder_ / file, setup).image;
    }

    static void expect_agreement(const Image& image, double spp, const Image& expected,
                                 const Limits& limits) {
        const ImageComparison pixels = compare(image, expected);
        EXPECT_EQ(pixels.non_finite, 0u);
        EXPECT_LE(pixels.mean_error(), limits.mean_error);
        const ZTest z = limits.block == 1
                            ? z_test(steadied(image), spp, expected, limits.reference_spp)
                            : z_test(in_blocks(image, limits.block), spp,
                                     in_blocks(expected, limits.block), limits.reference_spp);
        fmt::print("means {:+.4f} {:+.4f} {:+.4f} %, z of the means {:.2f} {:.2f} {:.2f}, largest "
                   "of {} tests {:.2f} at {} {}\n",
                   100 * (pixels.mean_ratio(0) - 1), 100 * (pixels.mean_ratio(1) - 1),
                   100 * (pixels.mean_ratio(2) - 1), z.mean_z[0], z.mean_z[1], z.mean_z[2], z.tests,
                   z.largest_z, z.largest_x, z.largest_y);
        EXPECT_TRUE(z.pixels_pass())
            << z.failed << " of " << z.tests << " channels of pixels or blocks";
        EXPECT_TRUE(z.mean_passes()) << "p = " << z.mean_p;
    }

  private:
    std::filesystem::path folder_;
};

TEST_F(SharedScenes, TheBoxOfMitsubaMatchesMitsuba) {
    find("mitsuba-cbox");
    if (IsSkipped())
        return;
    constexpr std::uint32_t spp = 256;
    const Limits limits{0.002, 1, 16384};
    const Image expected = reference("cbox_box_d8_256.exr");
    Image image = rendered("cbox.xml", spp);
    expect_agreement(image, spp, expected, limits);
    // And one wrong pixel of 65,536 would be seen: on the back wall, where a pixel has 3 % noise.
    Rgb& pixel = image.pixels.at(100 * 256 + 128);
    pixel = pixel * 1.3f;
    const ZTest wrong = z_test(steadied(image), spp, expected, limits.reference_spp);
    EXPECT_FALSE(wrong.pixels_pass());
    EXPECT_EQ(wrong.largest_x, 128);
    EXPECT_EQ(wrong.largest_y, 100);
}

/// Another renderer, with up to 64 bounces and its own idea of the tent filter.
TEST_F(SharedScenes, TheBoxOfTungstenMatchesInTheOldDialect) {
    find("cornell-box");
    if (IsSkipped())
        return;
    constexpr std::uint32_t spp = 2;
    expect_agreement(rendered("scene_v0.5.xml", spp), spp, reference("TungstenRender.exr"),
                     {0.005, 64, noiseless});
}

TEST_F(SharedScenes, TheBoxOfTungstenMatchesInTheNewDialect) {
    find("cornell-box");
    if (IsSkipped())
        return;
    constexpr std::uint32_t spp = 4;
    expect_agreement(rendered("scene_v3.xml", spp), spp, reference("TungstenRender.exr"),
                     {0.005, 32, noiseless});
}

/// Away from edges, where filters do not matter: the left block's shadow on floor and wall.
TEST_F(SharedScenes, TheBoxOfTungstenMatchesPixelByPixelAwayFromEdges) {
    find("cornell-box");
    if (IsSkipped())
        return;
    constexpr std::uint32_t spp = 128;
    constexpr Crop crop{230, 600, 192, 192};
    const Image reference_image = reference("TungstenRender.exr");
    const Image expected = cropped(reference_image, crop);
    const Image image = without_edges(steadied(rendered("scene_v0.5.xml", spp, crop)),
                                      reference_image, crop.x, crop.y);
    const ImageComparison same = compare(image, expected);
    fmt::print("{} of {} channels are not at edges\n", same.different_bits, same.values);
    EXPECT_GT(same.different_bits, same.values / 2);
    const ZTest z = z_test(image, spp, expected, noiseless);
    fmt::print("largest z of {} tests {:.2f} at {} {}\n", z.tests, z.largest_z, z.largest_x,
               z.largest_y);
    EXPECT_TRUE(z.passes()) << z.failed << " pixel channels, mean p = " << z.mean_p;
}

/// The comparison itself can fail: a picture 1 % too bright does.
TEST_F(SharedScenes, AnErrorOfOnePercentIsSeen) {
    find("mitsuba-cbox");
    if (IsSkipped())
        return;
    const Image expected = reference("cbox_box_d8_256.exr");
    Image brighter = expected;
    for (Rgb& p : brighter.pixels)
        p = p * 1.01f;
    brighter.variance.assign(expected.pixels.size(), {1, 1, 1});
    const ZTest z = z_test(in_blocks(brighter, 4), 64, in_blocks(expected, 4), 16384);
    EXPECT_FALSE(z.mean_passes());
    EXPECT_GT(compare(brighter, expected).mean_error(), 0.002);
}

} // namespace
} // namespace plumb::test
