/// \file  OpenEXR files, written and read with OpenEXR itself.
///
/// Not with OpenImageIO, though that could: linking it costs 0.28 s at every start of a program
/// (Debian 12: 261 shared libraries), three times what a 1 spp render may take. OpenEXR alone costs
/// nothing that can be measured. image_codec.h has the other formats.
#pragma once

#include "renderer/io/image_metadata.h"
#include "renderer/scene/image.h"

#include <filesystem>
#include <string>

namespace plumb {

struct ExrOptions {
    bool half =
        false; ///< 16-bit halves (overflow is infinite, as IEEE 754 rounds) or 32-bit floats
    std::string compression = "zip"; ///< one of exr_compressions()
};

/// `none rle zips zip piz pxr24 b44 b44a dwaa dwab`, separated by ", ". All but pxr24, b44, b44a,
/// dwaa and dwab keep every bit.
[[nodiscard]] std::string exr_compressions();
/// Throws SceneError (ErrorKind::usage) that lists the known names.
void check_exr_compression(const std::string& name);

/// The bytes of a scan-line EXR: channels R, G, B with Rec. 709 chromaticities and a D65 white; the
/// image's offset as data window inside the full film as display window; `variance.R` … `.B` as
/// 32-bit floats if the image has variance. A metadata name that is no valid attribute of the
/// format's own is written as given. Throws SceneError (ErrorKind::output).
[[nodiscard]] std::string encode_exr(const Image& image, const ExrOptions& options,
                                     const Metadata& metadata);

struct ExrContents {
    Image image;
    Metadata metadata; ///< the string, float and int attributes
};

/// Reads R, G, B (or Y alone as grey) of the first part, and the layer `variance` if it is there.
/// Alpha and other channels are left. Throws SceneError (ErrorKind::mesh) for anything else, before
/// memory is allocated for sizes that the file cannot hold.
[[nodiscard]] ExrContents read_exr(const std::filesystem::path& path);

} // namespace plumb
