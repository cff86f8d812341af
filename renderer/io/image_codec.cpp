#include "renderer/io/image_codec.h"

#include "renderer/io/image_container.h"
#include "renderer/io/image_module.h"

#include <bit>
#include <fmt/format.h>
#include <stdexcept>
#include <utility>

namespace plumb {
namespace {

/// OpenImageIO's name of a format.
const char* plugin_of(ImageFormat format) {
    switch (format) {
    case ImageFormat::hdr: return "hdr";
    case ImageFormat::tiff: return "tiff";
    case ImageFormat::png: return "png";
    case ImageFormat::jpeg: return "jpeg";
    case ImageFormat::pfm:
    case ImageFormat::ppm: return "pnm";
    case ImageFormat::exr: break;
    }
    throw std::logic_error("EXR has its own reader and writer");
}

/// One text for formats without named attributes: `name: value`, separated by line feeds.
std::string description_of(const Metadata& metadata) {
    std::string text;
    for (const auto& [name, value] : metadata) {
        const std::string shown =
            std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
        if (name != "software")
            text += fmt::format("{}{}: {}", text.empty() ? "" : "\n", name, shown);
    }
    return text;
}

std::string software_of(const Metadata& metadata) {
    for (const auto& [name, value] : metadata)
        if (name == "software" && std::holds_alternative<std::string>(value))
            return std::get<std::string>(value);
    return "Plumbline";
}

void append(void* context, const void* bytes, std::size_t count) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(bytes), count);
}

std::string encode(OiioEncodeRequest request, const Metadata& metadata) {
    const std::string software = software_of(metadata), description = description_of(metadata);
    const OiioAttribute attributes[] = {{"Software", software.c_str()},
                                        {"ImageDescription", description.c_str()}};
    request.attributes = attributes;
    request.attribute_count = std::size(attributes);
    std::string file;
    OiioError error{};
    if (!image_module().encode(&request, append, &file, &error))
        throw std::runtime_error(error.text);
    return file;
}

/// Rows from the bottom; a negative scale says little-endian
/// (www.pauldebevec.com/Research/HDR/PFM).
std::string encode_pfm(const PixelView<float>& pixels) {
    static_assert(std::endian::native == std::endian::little);
    std::string file = fmt::format("PF\n{} {}\n-1.0\n", pixels.width, pixels.height);
    const std::size_t row = static_cast<std::size_t>(pixels.width) * 3;
    for (std::size_t y = static_cast<std::size_t>(pixels.height); y-- > 0;) {
        const auto values = std::as_bytes(pixels.values.subspan(y * row, row));
        append(&file, values.data(), values.size());
    }
    return file;
}

struct Decoding {
    DecodedImage image;
    std::size_t file_bytes;
};

/// Refuses sizes that the file cannot hold: zlib, the densest coding of these formats, packs
/// 1 : 1032 at most.
float* allocate(void* context, const OiioImageInfo& info) {
    auto& [image, file_bytes] = *static_cast<Decoding*>(context);
    constexpr int largest_side = 65536;
    constexpr std::uint64_t densest = 1100;
    if (info.width < 1 || info.height < 1 || info.width > largest_side ||
        info.height > largest_side)
        throw std::runtime_error(fmt::format("bad size (got {}x{}, expected 1 … {})", info.width,
                                             info.height, largest_side));
    if (info.channels < 1 || info.channels > 4)
        throw std::runtime_error(
            fmt::format("bad number of channels (got {}, expected 1 … 4)", info.channels));
    const std::uint64_t values = static_cast<std::uint64_t>(info.width) *
                                 static_cast<std::uint64_t>(info.height) *
                                 static_cast<std::uint64_t>(info.channels);
    if (values / densest > file_bytes)
        throw std::runtime_error(fmt::format("the file is too short for {}x{} pixels ({} bytes)",
                                             info.width, info.height, file_bytes));
    image = {info.width, info.height, info.channels, info.floating, std::vector<float>(values)};
    return image.values.data();
}

} // namespace

std::string encode_image(ImageFormat format, const PixelView<std::uint8_t>& pixels,
                         const Metadata& metadata) {
    return encode(
        {plugin_of(format), pixels.width, pixels.height, nullptr, pixels.values.data(), nullptr, 0},
        metadata);
}

std::string encode_image(ImageFormat format, const PixelView<float>& pixels,
                         const Metadata& metadata) {
    if (format == ImageFormat::pfm)
        return encode_pfm(pixels);
    return encode(
        {plugin_of(format), pixels.width, pixels.height, pixels.values.data(), nullptr, nullptr, 0},
        metadata);
}

DecodedImage decode_image(ImageFormat format, std::string_view file) {
    check_image_container(format, file);
    const OiioDecodeRequest request{plugin_of(format), file.data(), file.size()};
    Decoding decoding{{}, file.size()};
    OiioError error{};
    if (!image_module().decode(&request, allocate, &decoding, &error))
        throw std::runtime_error(error.text);
    return std::move(decoding.image);
}

} // namespace plumb
