/// \file  Scene-linear pixels to display codes, through OpenColorIO.
#pragma once

#include "renderer/io/srgb.h"
#include "renderer/scene/image.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace plumb {

struct DisplayOptions {
    std::string view;   ///< of the configuration's default display; empty: its default view
    float exposure = 0; ///< stops: pixels are multiplied by 2^exposure before the view
    /// Configuration. Empty: `$OCIO` if that is set and not empty, else the built-in
    /// scenes/display.ocio with the views `sRGB` (default), `ACES SDR`, `Gamma 0.6` and `Raw`.
    std::filesystem::path config;
};

/// Throws SceneError (ErrorKind::usage) for a configuration that cannot be used, an unknown view
/// (naming the known ones) and an exposure that is not finite.
void check_display(const DisplayOptions& options);

/// 8-bit codes, three a pixel: exposure, view, clamp to 0 … 1, floor(255 s + 1/2). A NaN becomes
/// code 0; infinite and huge values act as ±65504, the largest half. Throws as check_display.
[[nodiscard]] std::vector<std::uint8_t> display_pixels(const Image& image,
                                                       const DisplayOptions& options);

} // namespace plumb
