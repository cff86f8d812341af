/// \file  Image formats other than EXR: pixels to bytes and back, in memory.
///
/// PFM is written here; all else is left to the OpenImageIO module (oiio_module.h says why it is a
/// module), which is loaded on first use: from `$PLUMB_MODULE_DIR`, the folder of the running
/// program, or `../lib/plumbline` beside it.
#pragma once

#include "renderer/io/image_format.h"
#include "renderer/io/image_metadata.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

/// Three values a pixel, row by row from the top.
template <typename T> struct PixelView {
    int width = 0, height = 0;
    std::span<const T> values;
};

/// The bytes of a PNG, JPEG (quality 95, no chroma subsampling) or PPM. `software` is kept under
/// that name and the rest of the metadata as a description, where the format has a place for it.
/// Throws std::runtime_error, without a path. Not for use by two threads at once.
[[nodiscard]] std::string encode_image(ImageFormat format, const PixelView<std::uint8_t>& pixels,
                                       const Metadata& metadata);
/// The same for scene-linear floats: HDR (8-bit mantissas under a shared exponent), TIFF (32-bit
/// floats) and PFM (32-bit floats, which keep every bit; no metadata).
[[nodiscard]] std::string encode_image(ImageFormat format, const PixelView<float>& pixels,
                                       const Metadata& metadata);

struct DecodedImage {
    int width = 0, height = 0;
    int channels = 0;          ///< 1 … 4: grey, grey and alpha, RGB, RGB and alpha
    bool floating = false;     ///< the file holds floats; else integers, scaled to 0 … 1
    std::vector<float> values; ///< row by row from the top, channels side by side; alpha separate
};

/// Decodes a whole file of any format but EXR. Throws std::runtime_error, without a path, for
/// content of another format and for sizes that the file cannot hold.
[[nodiscard]] DecodedImage decode_image(ImageFormat format, std::string_view file);

} // namespace plumb
