/// \file  Is an image file whole? Checks that the decoders leave out.
#pragma once

#include "renderer/io/image_format.h"

#include <string_view>

namespace plumb {

/// Refuses what OpenImageIO's decoders would report on stderr by themselves, or read all the same:
/// a PNG with a damaged or missing chunk, a PFM that is called PPM and the reverse. Other formats
/// pass: their decoders see for themselves. Throws std::runtime_error, without a path.
void check_image_container(ImageFormat format, std::string_view file);

} // namespace plumb
