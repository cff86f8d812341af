/// \file  Wavefront OBJ meshes.
///
/// A reader of the project's own, because tinyobjloader 2.0rc10 (Debian 12) returns wrong meshes
/// without an error. Measured: `f 1 2 9` and `f -1 -2 -9` over 3 vertices give the indices 8 and
/// -6, the latter without a warning; `f 4294967297 2 3` gives index 0; `v 1 2`, `v 12abc 0 0`,
/// `v 1,5 0 0` and `v x y z` are numbers to it and 1e999 is infinity; errors carry no column. It
/// took 3 times our CPU time on 110 MB of `v` and `f a b c` (1.50 s, 0.48 s).
#pragma once

#include "renderer/scene/scene.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

/// Reads a Wavefront OBJ file as one mesh in object space.
///
/// Read are `v`, `vn`, `vt` and `f`, with CRLF or LF, tabs, comments, `\` line continuations,
/// negative indices, and indices of vertices that come later in the file. Polygons become fans
/// around their first corner: right where they are convex. Groups, objects, smoothing groups,
/// materials, points and lines are ignored without a word; other statements with one warning.
/// Fourth coordinates and vertex colours are checked and ignored. Texture coordinates are stored
/// as in the file, v upwards (Mitsuba's flip_tex_coords is the caller's).
///
/// Normals are kept if every corner of every face has one, else dropped with a warning (flat); a
/// corner without texture coordinates among others that have them gets (0,0), with a warning. The
/// rest is finish_mesh: triangles without area dropped, zero normals replaced, triangles turned to
/// the side of their normals, each with a warning that carries the count. A file without faces
/// gives an empty mesh and a warning.
///
/// Throws SceneError(ErrorKind::mesh) with file:line:column for an index that is 0, before the
/// first or after the last vertex, or no integer; a face of fewer than 3 corners; coordinates that
/// are missing, superfluous, not finite, or beyond 1.8e18 (max_coordinate); a line longer than
/// 32 MiB; and for what MappedFile refuses.
[[nodiscard]] Mesh read_obj(const std::filesystem::path& file, std::vector<std::string>& warnings);

/// The same for the bytes of a file; `file` is its name, for messages and for the mesh.
[[nodiscard]] Mesh read_obj_text(const std::filesystem::path& file, std::string_view text,
                                 std::vector<std::string>& warnings);

} // namespace plumb
