/// \file  One image to any number of files.
#pragma once

#include "renderer/io/image_metadata.h"
#include "renderer/scene/image.h"

#include <filesystem>
#include <string>
#include <vector>

namespace plumb {

struct OutputOptions {
    /// Format by extension (image_format.h). exr, hdr, tif and pfm hold the scene-linear pixels as
    /// they are; png, jpg and ppm are 8-bit pictures for a display.
    std::vector<std::filesystem::path> files;
    bool half = false;               ///< EXR: 16-bit halves instead of 32-bit floats
    std::string compression = "zip"; ///< EXR: one of exr_compressions()
    std::string view;                ///< display files: see DisplayOptions
    float exposure = 0;              ///< stops, display files only
    std::filesystem::path ocio_config;
};

/// Finds what can be known before an image is there, so that no render is lost to a slip.
/// Throws SceneError (ErrorKind::output): unknown extension, missing or read-only folder, target a
/// folder or read-only, JPEG of more than 65500 pixels a side; (ErrorKind::usage): unknown view or
/// compression, unusable colour configuration, one file named twice. No files: nothing to refuse.
void check_outputs(const OutputOptions& options, int width, int height);

/// Writes every file, each whole or not at all (write_file.h), in the given order. Checks again
/// first; a failure leaves the files after it unwritten. Throws as check_outputs, and
/// SceneError (ErrorKind::output) when the disk refuses.
void write_images(const Image& image, const OutputOptions& options, const Metadata& metadata);

} // namespace plumb
