/// \file  EXR files: every bit comes back, and broken ones are refused.
#include "renderer/io/exr_file.h"

#include "renderer/scene/error.h"
#include "tests/support/random.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <unistd.h>

namespace plumb {
namespace {

/// A file of this process: ctest runs the tests as processes side by side.
std::filesystem::path temporary(const std::string& name) {
    return std::filesystem::path(testing::TempDir()) /
           ("plumb_exr_" + std::to_string(::getpid()) + "_" + name);
}

void store(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// Random values over many magnitudes, some negative, at an offset within a larger film.
Image noise(int width, int height, float largest) {
    Image image{width, height, width + 7, height + 5, 3, 2, {}, {}};
    test::Random random(7);
    const auto value = [&] {
        const float magnitude = largest * std::exp2(-random.uniform(0, 20));
        return random.uniform() < 0.1f ? -magnitude : magnitude;
    };
    for (int i = 0; i < width * height; ++i) {
        const float r = value(), g = value();
        image.pixels.push_back({r, g, value()});
    }
    return image;
}

void expect_same_bits(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(std::bit_cast<std::uint32_t>(a[i].r), std::bit_cast<std::uint32_t>(b[i].r));
        EXPECT_EQ(std::bit_cast<std::uint32_t>(a[i].g), std::bit_cast<std::uint32_t>(b[i].g));
        EXPECT_EQ(std::bit_cast<std::uint32_t>(a[i].b), std::bit_cast<std::uint32_t>(b[i].b));
    }
}

ExrContents round_trip(const Image& image, const ExrOptions& options, const Metadata& metadata) {
    const auto path = temporary("round_trip.exr");
    store(path, encode_exr(image, options, metadata));
    return read_exr(path);
}

std::string refusal(const std::filesystem::path& path) {
    try {
        static_cast<void>(read_exr(path));
    } catch (const SceneError& error) {
        EXPECT_EQ(error.kind(), ErrorKind::mesh);
        return error.what();
    }
    return "";
}

TEST(Exr, FloatsComeBackBitForBitWithEveryLosslessCompression) {
    Image image = noise(37, 21, 1e6f);
    image.pixels[0] = {std::numeric_limits<float>::infinity(), -0.0f, 0x1p-149f};
    for (const char* compression : {"none", "rle", "zips", "zip", "piz"}) {
        const Image back = round_trip(image, {false, compression}, {}).image;
        expect_same_bits(image.pixels, back.pixels);
    }
}

TEST(Exr, DataWindowLiesInsideTheDisplayWindow) {
    const Image image = noise(9, 4, 1);
    const Image back = round_trip(image, {}, {}).image;
    EXPECT_EQ(back.width, 9);
    EXPECT_EQ(back.height, 4);
    EXPECT_EQ(back.full_width, 16);
    EXPECT_EQ(back.full_height, 9);
    EXPECT_EQ(back.offset_x, 3);
    EXPECT_EQ(back.offset_y, 2);
    expect_same_bits(image.pixels, back.pixels);
}

TEST(Exr, HalvesComeBackWithinHalfAnUlp) {
    const Image image = noise(64, 64, 60000);
    const Image back = round_trip(image, {true, "zip"}, {}).image;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const float value = image.pixels[i].g, read = back.pixels[i].g;
        // A half has 11 significant bits; below 2^-14 its ulp is 2^-24.
        const int exponent = std::max(std::ilogb(value), -14);
        EXPECT_LE(std::abs(value - read), std::exp2(static_cast<float>(exponent - 11))) << value;
    }
}

TEST(Exr, HalfFileIsSmallerThanAFloatFile) {
    const Image image = noise(64, 64, 1);
    EXPECT_LT(encode_exr(image, {true, "none"}, {}).size(),
              encode_exr(image, {false, "none"}, {}).size() * 6 / 10);
}

TEST(Exr, VarianceComesBackBitForBitEvenFromAHalfFile) {
    Image image = noise(13, 5, 100);
    image.variance = noise(13, 5, 1e-6f).pixels;
    const Image back = round_trip(image, {true, "zip"}, {}).image;
    expect_same_bits(image.variance, back.variance);
    EXPECT_TRUE(round_trip(noise(13, 5, 1), {}, {}).image.variance.empty());
}

TEST(Exr, MetadataComesBackWithItsTypes) {
    const Metadata metadata{{"software", "Plumbline"}, {"spp", 64}, {"renderSeconds", 1.5f}};
    const Metadata back = round_trip(noise(2, 2, 1), {}, metadata).metadata;
    for (const auto& entry : metadata)
        EXPECT_NE(std::find(back.begin(), back.end(), entry), back.end()) << entry.first;
}

TEST(Exr, ChromaticitiesAreRec709WithD65) {
    const std::string bytes = encode_exr(noise(2, 2, 1), {}, {});
    const std::string name("chromaticities\0chromaticities\0", 30); // then the size, 4 bytes
    const std::size_t at = bytes.find(name);
    ASSERT_NE(at, std::string::npos);
    float values[8];
    std::memcpy(values, bytes.data() + at + name.size() + 4, sizeof(values));
    // ITU-R BT.709-6, items 1.3 and 1.4: red, green, blue, white.
    const float expected[] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
    for (std::size_t i = 0; i < 8; ++i)
        EXPECT_EQ(values[i], expected[i]) << i;
}

TEST(Exr, BytesDoNotDependOnTheNumberOfRuns) {
    const Image image = noise(1100, 1000, 1); // large enough for worker threads
    EXPECT_EQ(encode_exr(image, {}, {}), encode_exr(image, {}, {}));
}

TEST(Exr, UnknownCompressionIsAUsageErrorThatListsTheKnownOnes) {
    try {
        check_exr_compression("lzma");
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_NE(std::string(error.what()).find("dwab"), std::string::npos);
    }
    EXPECT_NO_THROW(check_exr_compression("dwaa"));
}

TEST(Exr, TruncatedFilesAreRefusedAtEveryLength) {
    const std::string whole = encode_exr(noise(40, 40, 1), {}, {});
    for (std::size_t length = 0; length < whole.size(); length += 97) {
        const auto path = temporary("truncated.exr");
        store(path, whole.substr(0, length));
        EXPECT_NE(refusal(path).find("truncated.exr: error: "), std::string::npos) << length;
    }
}

TEST(Exr, HugeDataWindowIsRefusedBeforeAnythingIsAllocated) {
    std::string bytes = encode_exr(noise(4, 4, 1), {}, {});
    const std::size_t window = bytes.find("dataWindow");
    const std::size_t value = window + std::string("dataWindow").size() + 1 + 6 + 4;
    for (const std::int32_t end : {0x7fffffff, 0x3fffffff, 60000}) {
        for (const std::size_t field : {8u, 12u})
            for (unsigned byte = 0; byte < 4; ++byte)
                bytes[value + field + byte] =
                    static_cast<char>(static_cast<std::uint32_t>(end) >> (8 * byte));
        const auto path = temporary("huge.exr");
        store(path, bytes);
        EXPECT_NE(refusal(path), "") << end;
    }
}

TEST(Exr, MissingFileDirectoryAndForeignContentAreRefused) {
    EXPECT_NE(refusal(temporary("missing.exr")), "");
    EXPECT_NE(refusal(testing::TempDir()), "");
    const auto path = temporary("text.exr");
    store(path, "not an image at all");
    EXPECT_NE(refusal(path), "");
}

} // namespace
} // namespace plumb
