/// \file  Every output format written and read back, and the refusals before a render.
#include "renderer/io/write_images.h"

#include "renderer/io/colour.h"
#include "renderer/io/exr_file.h"
#include "renderer/io/read_image.h"
#include "renderer/scene/error.h"
#include "tests/support/random.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <sys/resource.h>
#include <unistd.h>

namespace plumb {
namespace {

namespace fs = std::filesystem;

/// A gradient with values above 1, the same on every run.
Image gradient(int width, int height) {
    Image image{width, height, width, height, 0, 0, {}, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(width);
            const float v = static_cast<float>(y) / static_cast<float>(height);
            image.pixels.push_back({2 * u, v, 0.25f + 0.5f * u * v});
        }
    return image;
}

std::string bytes_of(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

class WriteImages : public testing::Test {
  protected:
    void SetUp() override {
        unsetenv("OCIO");
        folder_ = fs::path(testing::TempDir()) / ("plumb_images_" + std::to_string(::getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    [[nodiscard]] fs::path in_folder(const std::string& name) const { return folder_ / name; }

    /// Writes and reads back one file.
    [[nodiscard]] Image round_trip(const std::string& name, const Image& image) const {
        OutputOptions options;
        options.files = {in_folder(name)};
        write_images(image, options, {{"software", "Plumbline 1"}, {"spp", 4}});
        return read_image(in_folder(name));
    }
    static std::string refusal(const OutputOptions& options, ErrorKind kind, int width = 4,
                               int height = 4) {
        try {
            check_outputs(options, width, height);
        } catch (const SceneError& error) {
            EXPECT_EQ(error.kind(), kind) << error.what();
            return error.what();
        }
        return "";
    }

    fs::path folder_;
};

TEST_F(WriteImages, LinearFloatFormatsKeepEveryBitAndIgnoreExposure) {
    const Image image = gradient(33, 17);
    OutputOptions options;
    for (const char* name : {"a.exr", "a.tif", "a.TIFF", "a.pfm"})
        options.files.push_back(in_folder(name));
    options.exposure = 3;
    options.view = "Raw";
    write_images(image, options, {});
    for (const fs::path& file : options.files) {
        const Image back = read_image(file);
        ASSERT_EQ(back.width, 33) << file;
        ASSERT_EQ(back.height, 17) << file;
        EXPECT_EQ(back.pixels, image.pixels) << file;
    }
}

TEST_F(WriteImages, HdrIsWithinItsEightBitMantissa) {
    const Image image = gradient(40, 30);
    const Image back = round_trip("a.hdr", image);
    ASSERT_EQ(back.pixels.size(), image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const Rgb a = image.pixels[i], b = back.pixels[i];
        const float step = max_component(a) / 127; // one code, at most
        EXPECT_NEAR(a.r, b.r, step);
        EXPECT_NEAR(a.g, b.g, step);
        EXPECT_NEAR(a.b, b.b, step);
    }
}

TEST_F(WriteImages, PngAndPpmHoldExactlyTheCodesOfTheView) {
    const Image image = gradient(31, 9);
    const auto codes = display_pixels(image, {});
    for (const char* name : {"a.png", "a.ppm"}) {
        const Image back = round_trip(name, image);
        ASSERT_EQ(back.pixels.size() * 3, codes.size()) << name;
        for (std::size_t i = 0; i < back.pixels.size(); ++i) {
            EXPECT_EQ(std::lround(255 * back.pixels[i].r), codes[3 * i]) << name;
            EXPECT_EQ(std::lround(255 * back.pixels[i].g), codes[3 * i + 1]) << name;
            EXPECT_EQ(std::lround(255 * back.pixels[i].b), codes[3 * i + 2]) << name;
        }
    }
}

TEST_F(WriteImages, JpegIsCloseToTheCodesOfTheView) {
    const Image image = gradient(64, 48);
    const auto codes = display_pixels(image, {});
    const Image back = round_trip("a.jpg", image);
    ASSERT_EQ(back.pixels.size() * 3, codes.size());
    double sum = 0;
    for (std::size_t i = 0; i < back.pixels.size(); ++i)
        sum += std::abs(255 * double{back.pixels[i].g} - codes[3 * i + 1]);
    EXPECT_LT(sum / static_cast<double>(back.pixels.size()), 2);
}

TEST_F(WriteImages, SrgbDecodingGivesBackTheLinearValuesOfAPng) {
    Image image = gradient(16, 16);
    for (Rgb& c : image.pixels)
        c.r *= 0.5f;
    static_cast<void>(round_trip("a.png", image));
    const Image back = read_image(in_folder("a.png"), PixelDecoding::srgb);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        EXPECT_NEAR(back.pixels[i].r, image.pixels[i].r, 0.005); // 2.4 / 1.055 half codes at white
    // Floats are linear already.
    static_cast<void>(round_trip("a.tif", image));
    EXPECT_EQ(read_image(in_folder("a.tif"), PixelDecoding::srgb).pixels, image.pixels);
}

TEST_F(WriteImages, ViewAndExposureReachTheFile) {
    Image grey = gradient(8, 8);
    std::fill(grey.pixels.begin(), grey.pixels.end(), Rgb{0.09f, 0.09f, 0.09f});
    OutputOptions options;
    options.files = {in_folder("a.png")};
    options.view = "Gamma 0.6";
    options.exposure = 1;
    write_images(grey, options, {});
    EXPECT_EQ(std::lround(255 * read_image(in_folder("a.png")).pixels[0].g), 91);
}

TEST_F(WriteImages, SoftwareIsNamedInPngTiffAndJpeg) {
    for (const char* name : {"a.png", "a.tif", "a.jpg"}) {
        static_cast<void>(round_trip(name, gradient(8, 8)));
        EXPECT_NE(bytes_of(in_folder(name)).find("Plumbline 1"), std::string::npos) << name;
        EXPECT_NE(bytes_of(in_folder(name)).find("spp: 4"), std::string::npos) << name;
    }
}

TEST_F(WriteImages, ExrTakesHalfCompressionVarianceAndWindow) {
    Image image = gradient(8, 4);
    image.full_width = 20;
    image.full_height = 10;
    image.offset_x = 5;
    image.offset_y = 3;
    image.pixels[0].r = 0.1f; // has no exact half
    image.variance = image.pixels;
    OutputOptions options;
    options.files = {in_folder("a.exr")};
    options.half = true;
    options.compression = "piz";
    write_images(image, options, {{"spp", 16}});
    const ExrContents back = read_exr(in_folder("a.exr"));
    EXPECT_EQ(back.image.offset_x, 5);
    EXPECT_EQ(back.image.full_height, 10);
    EXPECT_EQ(back.image.variance, image.variance);
    EXPECT_EQ(back.image.pixels[0].r, 0x1.998p-4f); // 0.1 rounded to 11 bits
    // The attribute `compression`: a name, its type, four bytes of size, and the value (piz is 4).
    const std::string name("compression\0compression\0\1\0\0\0\4", 29);
    EXPECT_NE(bytes_of(in_folder("a.exr")).find(name), std::string::npos);
}

TEST_F(WriteImages, FullDiskFailsInEveryFormatAndKeepsTheOldFile) {
    test::Random random(3);
    Image image = gradient(64, 64);
    for (Rgb& c : image.pixels) // noise: nothing that compresses
        c = {random.uniform(), random.uniform(), random.uniform()};
    for (const char* name : {"a.exr", "a.hdr", "a.tif", "a.pfm", "a.png", "a.jpg", "a.ppm"}) {
        const fs::path file = in_folder(name);
        std::ofstream(file) << "old";
        OutputOptions options;
        options.files = {file};
        rlimit before{};
        getrlimit(RLIMIT_FSIZE, &before);
        const rlimit limited{2000, before.rlim_max};
        const auto handler = std::signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &limited);
        EXPECT_THROW(write_images(image, options, {}), SceneError) << name;
        setrlimit(RLIMIT_FSIZE, &before);
        std::signal(SIGXFSZ, handler);
        EXPECT_EQ(bytes_of(file), "old") << name;
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 7);
}

TEST_F(WriteImages, UnknownExtensionNamesTheKnownOnes) {
    OutputOptions options;
    for (const char* name : {"a.bmp", "a", "a.exr.gz", ".exr"}) {
        options.files = {in_folder(name)};
        const std::string text = refusal(options, ErrorKind::output);
        EXPECT_NE(text.find("exr, hdr, tif, tiff, pfm, png, jpg, jpeg, ppm"), std::string::npos)
            << text;
    }
}

TEST_F(WriteImages, JpegWiderThanItsFormatIsRefusedBeforehand) {
    OutputOptions options;
    options.files = {in_folder("a.jpg")};
    EXPECT_EQ(refusal(options, ErrorKind::output, 65500, 4), "");
    EXPECT_NE(refusal(options, ErrorKind::output, 65501, 4).find("65500"), std::string::npos);
    EXPECT_NE(refusal(options, ErrorKind::output, 4, 65501).find("65500"), std::string::npos);
    options.files = {in_folder("a.png")};
    EXPECT_EQ(refusal(options, ErrorKind::output, 65501, 4), "");
}

TEST_F(WriteImages, OneFileNamedTwiceIsRefusedUnderAnySpelling) {
    OutputOptions options;
    options.files = {in_folder("a.exr"), in_folder("b.exr"), in_folder("./a.exr")};
    EXPECT_NE(refusal(options, ErrorKind::usage).find("twice"), std::string::npos);
    options.files.pop_back();
    EXPECT_EQ(refusal(options, ErrorKind::usage), "");
}

TEST_F(WriteImages, BadFoldersViewsAndCompressionsAreRefusedBeforehand) {
    OutputOptions options;
    options.files = {in_folder("missing/a.exr")};
    EXPECT_NE(refusal(options, ErrorKind::output), "");
    options.files = {in_folder("a.png")};
    options.view = "Filmic";
    EXPECT_NE(refusal(options, ErrorKind::usage), "");
    options.view = "";
    options.compression = "lzma";
    EXPECT_NE(refusal(options, ErrorKind::usage), "");
    EXPECT_EQ(refusal({}, ErrorKind::usage), ""); // nothing to write is no error
}

TEST_F(WriteImages, CheckLeavesNothingBehind) {
    OutputOptions options;
    options.files = {in_folder("a.exr"), in_folder("a.png")};
    check_outputs(options, 4, 4);
    EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(WriteImages, EmptyImageIsRefusedInEveryFormat) {
    OutputOptions options;
    for (const char* name : {"a.exr", "a.png", "a.pfm"}) {
        options.files = {in_folder(name)};
        EXPECT_THROW(write_images(Image{}, options, {}), SceneError) << name;
    }
    EXPECT_TRUE(fs::is_empty(folder_));
}

} // namespace
} // namespace plumb
