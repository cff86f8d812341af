/// \file  The generated shapes of scene files, in Mitsuba's conventions, as triangle meshes.
#pragma once

#include "renderer/scene/mesh_edit.h"

namespace plumb {

/// Triangles of a disk; columns of quadrilaterals of a cylinder.
inline constexpr std::uint32_t tessellation_segments = 256;

// All are in world space, and their front stays the outer side (rectangle, disk: the side of +z
// before the transform) under any affine, invertible transform, mirrors included. flip_normals
// turns them inside out. Flat shapes carry no normals: the geometric one is exact.

/// [-1,1]^2 at z = 0, front +z, uv = (x + 1, y + 1) / 2. Sets Mesh::is_rectangle unless the
/// transform shears it.
[[nodiscard]] Mesh make_rectangle(const Transform& to_world);

/// [-1,1]^3: 24 vertices, so that each face has its own corners and covers uv [0,1]^2.
[[nodiscard]] Mesh make_cube(const Transform& to_world);

/// The unit disk at z = 0, front +z, uv = (r, phi / 2 pi). A fan of n = 256 triangles whose corners
/// lie at sqrt((2 pi/n) / sin(2 pi/n)) = 1 + 5.0e-5, so that its area is pi exactly (to float
/// rounding); the rim is off by at most 5.0e-5 outwards at the corners and 2.5e-5 inwards between.
[[nodiscard]] Mesh make_disk(const Transform& to_world);

/// The side of the cylinder of `radius` > 0 around the segment from p0 to p1 (p0 != p1), open at
/// both ends, front outside, uv = (phi / 2 pi, distance from p0 / length). A prism of n = 256
/// quadrilaterals whose edges lie at (pi/n) / sin(pi/n) = 1 + 2.5e-5 radii, so that its area is
/// 2 pi radius length exactly (to float rounding); the surface is off by at most 2.5e-5 radii
/// outwards at the edges and 5.0e-5 inwards between. Vertices have the cylinder's own normals.
[[nodiscard]] Mesh make_cylinder(Vec3 p0, Vec3 p1, float radius, const Transform& to_world);

} // namespace plumb
