/// \file  What every mesh reader promises, checked on any bytes.
#pragma once

#include "renderer/scene/error.h"
#include "renderer/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace plumb::fuzz {

/// Throws Finding unless indices are in range, coordinates finite, normals unit vectors, attributes
/// one a vertex, and no triangle has two equal corners.
void require_sound(const Mesh& mesh);

/// Throws Finding unless the message is `FILE:LINE:COL: error: what` in one line of printable
/// characters, with any lines `  included from FILE:LINE:COL` below it.
void require_well_formed(const SceneError& error);

using MeshReader = Mesh (*)(const std::filesystem::path& file, std::string_view bytes,
                            std::vector<std::string>& warnings);

/// Reads the bytes, which lie in a block of exactly their size, and checks what comes of it.
void require_reads_or_refuses(MeshReader read, const std::uint8_t* data, std::size_t size);

} // namespace plumb::fuzz
