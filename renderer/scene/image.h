/// \file  A scene-linear image in memory.
#pragma once

#include "renderer/scene/rgb.h"
#include "renderer/scene/settings.h"

#include <vector>

namespace plumb {

/// Scene-linear Rec. 709 pixels, row by row from the top left.
struct Image {
    int width = 0, height = 0; ///< of the pixels held
    /// Where the pixels lie in the full film: an EXR's data window inside its display window.
    int full_width = 0, full_height = 0, offset_x = 0, offset_y = 0;
    std::vector<Rgb> pixels;
    /// Sample variance of one sample, a pixel each, if it was asked for; else empty.
    std::vector<Rgb> variance;
};

} // namespace plumb
