/// \file  Scenes with reference images by other renderers, where they lie beside the project.
///
/// The z-tests run over blocks of pixels with thousands of samples each. With fewer, mean and
/// sample variance of a dark block are both too low where a rare bright path happens to be missing:
/// at 1024 samples one block in 4096 of the Tungsten scene stood at z = 5.8, and at 65,536 at 0.3.
/// And at edges another renderer's filter gives another pixel, but the same block.

#include "tests/support/render_scene.h"
#include "tests/support/shared_scene.h"

#include "renderer/io/compare_images.h"
#include "renderer/io/read_image.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <limits>

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

/// What a scene is held to.
struct Limits {
    double mean_error;    ///< relative, of the image mean of each channel
    int block;            ///< pixels
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
    [[nodiscard]] Image rendered(const char* file, std::uint32_t spp) const {
        RenderSetup setup;
        setup.variance = true;
        setup.threads = 0;
        setup.adjust = [spp](Scene& scene) { scene.sampler = {SamplerKind::independent, spp, 1}; };
        return render_file(folder_ / file, setup).image;
    }

    static void expect_agreement(const Image& image, double spp, const Image& expected,
                                 const Limits& limits) {
        const ImageComparison pixels = compare(image, expected);
        EXPECT_EQ(pixels.non_finite, 0u);
        EXPECT_LE(pixels.mean_error(), limits.mean_error);
        const ZTest z = z_test(in_blocks(image, limits.block), spp,
                               in_blocks(expected, limits.block), limits.reference_spp);
        fmt::print("means {:+.4f} {:+.4f} {:+.4f} %, z of the means {:.2f} {:.2f} {:.2f}, largest "
                   "of {} blocks {:.2f} at {} {}\n",
                   100 * (pixels.mean_ratio(0) - 1), 100 * (pixels.mean_ratio(1) - 1),
                   100 * (pixels.mean_ratio(2) - 1), z.mean_z[0], z.mean_z[1], z.mean_z[2], z.tests,
                   z.largest_z, z.largest_x, z.largest_y);
        EXPECT_TRUE(z.pixels_pass()) << z.failed << " of " << z.tests << " block channels";
        EXPECT_TRUE(z.mean_passes()) << "p = " << z.mean_p;
    }

  private:
    std::filesystem::path folder_;
};

TEST_F(SharedScenes, TheBoxOfMitsubaMatchesMitsuba) {
    find("mitsuba-cbox");
    if (IsSkipped())
        return;
    constexpr std::uint32_t spp = 64;
    expect_agreement(rendered("cbox.xml", spp), spp, reference("cbox_box_d8_256.exr"),
                     {0.002, 8, 16384});
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
