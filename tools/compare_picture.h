/// \file  A picture of where two images differ.
#pragma once

#include "renderer/scene/image.h"

#include <optional>

namespace plumb {

/// a - b, pixel by pixel. The sizes must be equal.
[[nodiscard]] Image signed_difference(const Image& a, const Image& b);

/// For the eye: of each pixel's channels the largest difference, red if a is brighter, blue if b
/// is, scene-linear; NaN and infinite differences are green. `scale`: the difference that is shown
/// as 1; empty: what 99 % of the pixels stay below, and 1 where that is 0.
[[nodiscard]] Image difference_picture(const Image& a, const Image& b, std::optional<float> scale);

} // namespace plumb
