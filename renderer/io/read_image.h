/// \file  Any supported image file to RGB floats.
#pragma once

#include "renderer/scene/image.h"

#include <cstdint>
#include <filesystem>

namespace plumb {

/// What becomes of files that hold integers: PNG, JPEG, PPM and integer TIFF. Files that hold
/// floats (EXR, HDR, PFM, float TIFF) are scene-linear either way.
enum class PixelDecoding : std::uint8_t {
    stored, ///< scaled to 0 … 1, else as they are: for data, and to compare codes
    srgb    ///< from sRGB codes to linear: for colours
};

/// Grey becomes three equal channels; alpha is left out. The format is the extension's and the
/// content must be of it. Throws SceneError (ErrorKind::mesh).
[[nodiscard]] Image read_image(const std::filesystem::path& path,
                               PixelDecoding decoding = PixelDecoding::stored);

} // namespace plumb
