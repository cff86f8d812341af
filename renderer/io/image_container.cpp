#include "renderer/io/image_container.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace plumb {
namespace {

std::uint32_t byte_at(std::string_view bytes, std::size_t at) {
    return static_cast<unsigned char>(bytes[at]);
}

std::uint32_t big_endian(std::string_view bytes) {
    return byte_at(bytes, 0) << 24u | byte_at(bytes, 1) << 16u | byte_at(bytes, 2) << 8u |
           byte_at(bytes, 3);
}

/// CRC of ISO 3309, as PNG (ISO/IEC 15948, annex D) takes it: a table of one byte's remainders.
std::uint32_t crc32(std::string_view bytes) {
    static constexpr auto table = [] {
        std::array<std::uint32_t, 256> remainders{};
        for (std::uint32_t n = 0; n < 256; ++n) {
            std::uint32_t c = n;
            for (int bit = 0; bit < 8; ++bit)
                c = (c & 1u) != 0 ? 0xedb88320u ^ (c >> 1u) : c >> 1u;
            remainders[n] = c;
        }
        return remainders;
    }();
    std::uint32_t crc = 0xffffffffu;
    for (std::size_t i = 0; i < bytes.size(); ++i)
        crc = table[(crc ^ byte_at(bytes, i)) & 0xffu] ^ (crc >> 8u);
    return ~crc;
}

/// Width, height, bit depth and colour type (ISO/IEC 15948, table 11.1).
void check_png_header(std::string_view data) {
    constexpr std::size_t header_bytes = 13;
    if (data.size() != header_bytes || big_endian(data) == 0 || big_endian(data.substr(4)) == 0)
        throw std::runtime_error("the PNG has a bad header");
    const std::uint32_t depth = byte_at(data, 8), colour = byte_at(data, 9);
    const bool bytes = depth == 8 || depth == 16;
    const bool bits = depth == 1 || depth == 2 || depth == 4;
    const bool known = colour == 0   ? bits || bytes
                       : colour == 3 ? bits || depth == 8
                                     : bytes && (colour == 2 || colour == 4 || colour == 6);
    if (!known)
        throw std::runtime_error("the PNG has a bad header (got bit depth " +
                                 std::to_string(depth) + " with colour type " +
                                 std::to_string(colour) + ")");
}

/// Walks the chunks (length, name, data, CRC) from IHDR to IEND.
void check_png(std::string_view file) {
    constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);
    constexpr std::size_t frame = 12; // all of a chunk but its data
    if (!file.starts_with(signature))
        throw std::runtime_error("the content is no PNG");
    file.remove_prefix(signature.size());
    bool pixels = false;
    for (bool first = true;; first = false) {
        if (file.size() < frame || big_endian(file) > file.size() - frame)
            throw std::runtime_error("the PNG is truncated");
        const std::size_t length = big_endian(file);
        const std::string_view name = file.substr(4, 4);
        if (crc32(file.substr(4, 4 + length)) != big_endian(file.substr(8 + length)))
            throw std::runtime_error("the PNG is damaged: wrong check sum of a chunk");
        if (first != (name == "IHDR"))
            throw std::runtime_error("the PNG does not begin with its header");
        if (first)
            check_png_header(file.substr(8, length));
        pixels = pixels || name == "IDAT";
        if (name == "IEND" && !pixels)
            throw std::runtime_error("the PNG has no pixels");
        if (name == "IEND")
            return;
        file.remove_prefix(frame + length);
    }
}

/// OpenImageIO reads both with one plugin.
void check_pnm(std::string_view file, bool expect_pfm) {
    const bool pfm = file.starts_with("PF") || file.starts_with("Pf");
    if (pfm != expect_pfm)
        throw std::runtime_error(pfm ? "the content is a PFM" : "the content is no PFM");
}

} // namespace

void check_image_container(ImageFormat format, std::string_view file) {
    switch (format) {
    case ImageFormat::png: return check_png(file);
    case ImageFormat::pfm: return check_pnm(file, true);
    case ImageFormat::ppm: return check_pnm(file, false);
    case ImageFormat::exr:
    case ImageFormat::hdr:
    case ImageFormat::jpeg:
    case ImageFormat::tiff: return;
    }
}

} // namespace plumb
