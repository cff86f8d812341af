/// \file  PLY meshes.
///
/// A reader of the project's own: Debian 12 packages no PLY library.
#pragma once

#include "renderer/scene/scene.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

/// Reads a PLY file, ASCII or binary of either byte order, as one mesh in object space.
///
/// Element `vertex`: x y z, and, where they are complete, nx ny nz and one pair of texture
/// coordinates (u v, s t, texture_u texture_v, texture_s texture_t), of any type. Element `face`: a
/// list vertex_indices or vertex_index of any integer type; polygons become fans. Elements may
/// come in any order; other elements and properties are skipped. In ASCII files a row is a line.
/// The rest is finish_mesh: triangles without area dropped, zero normals replaced, triangles
/// turned to the side of their normals, each with a warning that carries the count. A file without
/// faces gives an empty mesh and a warning, so do bytes after the last element.
///
/// Throws SceneError(ErrorKind::mesh), with line and column in headers and ASCII bodies, with the
/// byte in binary bodies, for what read_ply_header refuses, a missing `vertex` or x y z, triangle
/// strips, a truncated body, rows too short or too long, lists of fewer than 3 indices, indices out
/// of range, numbers that are not finite or beyond 1.8e18; and for what MappedFile refuses.
[[nodiscard]] Mesh read_ply(const std::filesystem::path& file, std::vector<std::string>& warnings);

/// The same for the bytes of a file; `file` is its name, for messages and for the mesh.
[[nodiscard]] Mesh read_ply_text(const std::filesystem::path& file, std::string_view bytes,
                                 std::vector<std::string>& warnings);

} // namespace plumb
