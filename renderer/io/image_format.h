/// \file  Image file formats and the extensions that name them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace plumb {

enum class ImageFormat : std::uint8_t { exr, hdr, tiff, pfm, png, jpeg, ppm };

/// By the extension, in any case: exr hdr tif tiff pfm png jpg jpeg ppm. Empty for any other.
[[nodiscard]] std::optional<ImageFormat> image_format_of(const std::filesystem::path& path);

/// The extensions above, separated by ", ".
[[nodiscard]] std::string image_extensions();

/// True for png, jpeg and ppm, which hold bytes for a display; the others hold scene-linear floats.
[[nodiscard]] constexpr bool is_display_format(ImageFormat format) {
    return format == ImageFormat::png || format == ImageFormat::jpeg || format == ImageFormat::ppm;
}

} // namespace plumb
