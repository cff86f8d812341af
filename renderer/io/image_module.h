/// \file  Finds and loads the OpenImageIO module. Private to image_codec.cpp.
#pragma once

#include "renderer/io/oiio_module/oiio_module.h"

namespace plumb {

struct ImageModule {
    OiioEncodeFunction* encode;
    OiioDecodeFunction* decode;
};

/// Loads the module on the first call, thread-safe; it stays loaded. Throws std::runtime_error that
/// names the places searched.
[[nodiscard]] const ImageModule& image_module();

} // namespace plumb
