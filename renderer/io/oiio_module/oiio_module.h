/// \file  What the renderer and its OpenImageIO module say to each other: a C interface.
///
/// The module is a shared library of its own, because linking OpenImageIO costs every start of a
/// program 0.28 s (Debian 12: 261 shared libraries to load), and a 1 spp render shall be on disk
/// within 0.10 s. It is loaded when the first file that is no EXR is read or written.
#pragma once

#include <cstddef>

namespace plumb {

/// Grows with every change of this file: a module of another build is refused.
inline constexpr int oiio_module_version = 1;

/// A text attribute under OpenImageIO's name for it, such as `Software`.
struct OiioAttribute {
    const char* name;
    const char* value;
};

/// An image to encode: rows from the top, three channels a pixel, all values floats or all bytes.
struct OiioEncodeRequest {
    const char* format; ///< OpenImageIO's name: hdr tiff png jpeg pnm
    int width, height;
    const float* floats; ///< exactly one of the two is not null
    const unsigned char* bytes;
    const OiioAttribute* attributes;
    std::size_t attribute_count;
};

struct OiioDecodeRequest {
    const char* format;
    const void* data; ///< the whole file
    std::size_t size;
};

/// What a file holds, told before its pixels are read.
struct OiioImageInfo {
    int width, height, channels;
    bool floating; ///< stored as floating point, not as integers (which come as 0 … 1)
};

/// Where a failure is described; always ends in a zero.
struct OiioError {
    char text[512];
};

/// Takes encoded bytes, in order. May throw.
using OiioSink = void (*)(void* context, const void* bytes, std::size_t count);
/// Answers with room for width * height * channels floats, or null to refuse. May throw.
using OiioAllocate = float* (*)(void* context, const OiioImageInfo& info);

extern "C" {
using OiioVersionFunction = int();
/// True if it worked; else the reason is in `error`.
using OiioEncodeFunction = bool(const OiioEncodeRequest* request, OiioSink sink, void* context,
                                OiioError* error);
using OiioDecodeFunction = bool(const OiioDecodeRequest* request, OiioAllocate allocate,
                                void* context, OiioError* error);
}

} // namespace plumb
