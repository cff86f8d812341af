/// \file  The number by which images are said to be the same.
#pragma once

#include "renderer/scene/image.h"

#include <bit>
#include <cstdint>

namespace plumb {

/// FNV-1a (64 bit) over the bits of the pixels: equal images, equal hashes, on any machine of one
/// endianness.
[[nodiscard]] inline std::uint64_t hash_of(const Image& image) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto add = [&hash](float value) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        for (int shift = 0; shift < 32; shift += 8)
            hash = (hash ^ ((bits >> shift) & 0xffu)) * 0x100000001b3u;
    };
    for (const Rgb& p : image.pixels) {
        add(p.r);
        add(p.g);
        add(p.b);
    }
    return hash;
}

} // namespace plumb
