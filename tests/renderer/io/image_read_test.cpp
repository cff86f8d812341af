/// \file  Image files that are broken, foreign or unusual.
#include "renderer/io/image_codec.h"
#include "renderer/io/read_image.h"
#include "renderer/scene/error.h"

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace plumb {
namespace {

/// A file of this process: ctest runs the tests as processes side by side.
std::filesystem::path temporary(const std::string& name) {
    return std::filesystem::path(testing::TempDir()) /
           ("plumb_read_" + std::to_string(::getpid()) + "_" + name);
}

std::filesystem::path store(const std::string& name, const std::string& bytes) {
    const auto path = temporary(name);
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path;
}

std::string refusal(const std::filesystem::path& path) {
    try {
        static_cast<void>(read_image(path));
    } catch (const SceneError& error) {
        EXPECT_EQ(error.kind(), ErrorKind::mesh);
        EXPECT_EQ(std::string(error.what()).find(path.string() + ": error: "), 0u) << error.what();
        return error.what();
    }
    return "";
}

std::string encoded(ImageFormat format) {
    std::vector<std::uint8_t> codes(64 * 48 * 3);
    std::vector<float> values(codes.size());
    for (std::size_t i = 0; i < codes.size(); ++i) {
        codes[i] = static_cast<std::uint8_t>((i * 2654435761u) >> 24u); // nothing compressible
        values[i] = static_cast<float>(codes[i]) / 200;
    }
    if (is_display_format(format))
        return encode_image(format, PixelView<std::uint8_t>{64, 48, codes}, {});
    return encode_image(format, PixelView<float>{64, 48, values}, {});
}

constexpr std::array<std::pair<const char*, ImageFormat>, 6> formats{{{"a.hdr", ImageFormat::hdr},
                                                                      {"a.tif", ImageFormat::tiff},
                                                                      {"a.pfm", ImageFormat::pfm},
                                                                      {"a.png", ImageFormat::png},
                                                                      {"a.jpg", ImageFormat::jpeg},
                                                                      {"a.ppm", ImageFormat::ppm}}};

TEST(ReadImage, WholeFilesOfEveryFormatAreRead) {
    for (const auto& [name, format] : formats) {
        const Image image = read_image(store(name, encoded(format)));
        EXPECT_EQ(image.width, 64) << name;
        EXPECT_EQ(image.height, 48) << name;
        EXPECT_EQ(image.pixels.size(), 64u * 48) << name;
    }
}

TEST(ReadImage, TruncatedFilesAreRefused) {
    for (const auto& [name, format] : formats) {
        const std::string whole = encoded(format);
        for (const std::size_t length :
             {std::size_t{0}, std::size_t{1}, std::size_t{10}, whole.size() / 4, whole.size() / 2})
            EXPECT_NE(refusal(store(name, whole.substr(0, length))), "") << name << " " << length;
    }
}

TEST(ReadImage, DamagedPngChunksAreRefusedAndNothingElseIsPrinted) {
    const std::string whole = encoded(ImageFormat::png);
    testing::internal::CaptureStderr();
    for (std::size_t at = 0; at < whole.size(); at += 61) {
        std::string bytes = whole;
        bytes[at] = static_cast<char>(bytes[at] ^ 0x20);
        EXPECT_NE(refusal(store("a.png", bytes)), "") << at;
    }
    for (std::size_t length = 0; length < whole.size(); length += 61)
        EXPECT_NE(refusal(store("a.png", whole.substr(0, length))), "") << length;
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(ReadImage, PngWithBadHeaderOrNoPixelsIsRefusedAndNothingElseIsPrinted) {
    // The check sums are right; zlib's crc32 gave them.
    const std::string signature("\x89PNG\r\n\x1a\n", 8);
    const std::string end("\0\0\0\0IEND\xae\x42\x60\x82", 12);
    const std::string depth_3("\0\0\0\x0dIHDR\0\0\0\1\0\0\0\1\3\0\0\0\0"
                              "\115\256\252\104",
                              25);
    const std::string grey_8("\0\0\0\x0dIHDR\0\0\0\1\0\0\0\1\x08\0\0\0\0"
                             "\072\176\233\125",
                             25);
    testing::internal::CaptureStderr();
    EXPECT_NE(refusal(store("a.png", signature + depth_3 + end)).find("bit depth 3"),
              std::string::npos);
    EXPECT_NE(refusal(store("a.png", signature + grey_8 + end)).find("no pixels"),
              std::string::npos);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(ReadImage, EndOfAThumbnailIsNotTheEndOfATruncatedJpeg) {
    const std::string whole = encoded(ImageFormat::jpeg);
    const std::string thumbnail("\xff\xe1\x00\x04\xff\xd9",
                                6); // a segment with an end marker in it
    const std::string start = whole.substr(0, 2) + thumbnail;
    EXPECT_EQ(read_image(store("a.jpg", start + whole.substr(2))).width, 64);
    EXPECT_NE(refusal(store("a.jpg", start + whole.substr(2, whole.size() / 2))), "");
}

TEST(ReadImage, BytesAfterTheEndOfAJpegAreAllowed) {
    const Image image = read_image(store("a.jpg", encoded(ImageFormat::jpeg) + "trailer"));
    EXPECT_EQ(image.width, 64);
}

TEST(ReadImage, ContentOfAnotherFormatIsRefused) {
    for (const auto& [name, format] : formats)
        for (const auto& [other_name, other] : formats)
            if (format != other && !(format == ImageFormat::ppm || format == ImageFormat::pfm) &&
                !(other == ImageFormat::ppm || other == ImageFormat::pfm)) {
                EXPECT_NE(refusal(store(name, encoded(other))), "") << name << other_name;
            }
    EXPECT_NE(refusal(store("a.png", "GIF89a and more that no one reads")), "");
    EXPECT_NE(refusal(store("a.ppm", encoded(ImageFormat::pfm))), "");
    EXPECT_NE(refusal(store("a.pfm", encoded(ImageFormat::ppm))), "");
}

TEST(ReadImage, UnknownExtensionMissingFileAndFolderAreRefused) {
    EXPECT_NE(refusal(store("a.gif", "GIF89a")).find("unknown image format"), std::string::npos);
    EXPECT_NE(refusal(temporary("missing.png")), "");
    std::filesystem::create_directories(temporary("folder.png"));
    EXPECT_NE(refusal(temporary("folder.png")), "");
}

TEST(ReadImage, SizesThatTheFileCannotHoldAreRefused) {
    EXPECT_NE(refusal(store("a.ppm", "P6\n60000 60000\n255\nxxxx")), "");
    EXPECT_NE(refusal(store("a.ppm", "P6\n2147483647 2147483647\n255\nxxxx")), "");
    EXPECT_NE(refusal(store("a.ppm", "P6\n0 5\n255\nxxxx")), "");
    EXPECT_NE(refusal(store("a.ppm", "P6\n-3 5\n255\nxxxx")), "");
    EXPECT_NE(refusal(store("a.pfm", "PF\n50000 50000\n-1.0\nxxxx")), "");
    std::string png = encoded(ImageFormat::png); // width and height follow the chunk's name
    const std::size_t header = png.find("IHDR") + 4;
    for (const std::size_t at : {header + 1, header + 5})
        png[at] = '\x70';
    EXPECT_NE(refusal(store("a.png", png)), "");
}

TEST(ReadImage, GreyBecomesThreeEqualChannels) {
    const Image image = read_image(store("a.ppm", "P5\n2 1\n255\n\x33\xff"));
    ASSERT_EQ(image.pixels.size(), 2u);
    EXPECT_FLOAT_EQ(image.pixels[0].r, 0.2f);
    EXPECT_EQ(image.pixels[0].g, image.pixels[0].r);
    EXPECT_EQ(image.pixels[1], (Rgb{1, 1, 1}));
}

TEST(ReadImage, PfmRowsRunFromTheBottom) {
    const float values[] = {1, 2, 3, 4, 5, 6}; // two rows of one pixel, top first
    const std::string file = encode_image(ImageFormat::pfm, PixelView<float>{1, 2, values}, {});
    EXPECT_EQ(file.substr(0, 12), "PF\n1 2\n-1.0\n");
    float first = 0;
    std::memcpy(&first, file.data() + 12, sizeof(first));
    EXPECT_EQ(first, 4);
    const Image image = read_image(store("a.pfm", file));
    ASSERT_EQ(image.pixels.size(), 2u);
    EXPECT_EQ(image.pixels[0], (Rgb{1, 2, 3}));
    EXPECT_EQ(image.pixels[1], (Rgb{4, 5, 6}));
}

} // namespace
} // namespace plumb
