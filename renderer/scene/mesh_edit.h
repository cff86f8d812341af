/// \file  What a scene file can ask of a mesh after it is read: transform, flip, drop normals.
#pragma once

#include "accel/math/transform.h"
#include "renderer/scene/scene.h"

namespace plumb {

/// Moves positions and unit normals to world space. The transform must be affine and invertible.
///
/// The front stays on the side that Mitsuba gives it. A mesh with normals keeps the front on their
/// side: a mirroring transform (negative determinant) turns its triangles over. A mesh without
/// normals has its front on the counter-clockwise side of its world-space vertices, so that a
/// mirror moves the front to the other side; hence drop_normals belongs before, compute_normals
/// after this. A rectangle that is sheared (by a cosine above 1e-5) is a rectangle no longer.
void apply_transform(Mesh& mesh, const Transform& to_world);

/// Reverses the winding of the triangles and leaves the normals: two vertices of each triangle
/// change places, or two vertices of a rectangle, whose triangles have a fixed form.
void turn_over(Mesh& mesh);

/// Swaps front and back: turn_over, and the sign of the normals.
void flip_normals(Mesh& mesh);

/// Mitsuba's face_normals: flat shading, by the winding.
void drop_normals(Mesh& mesh);

/// Gives each vertex the mean of the normals of its triangles, weighted by their angles at it
/// (G. Thürmer & C. Wüthrich, "Computing Vertex Normals from Polygonal Facets", JGT 3(1), 1998),
/// on the counter-clockwise side. Mitsuba does this to files without normals unless face_normals
/// is set. Vertices of no triangle with an area, or whose sum is zero, get (0,0,1).
void compute_normals(Mesh& mesh);

/// Whether every vertex normal is the geometric normal of all its triangles (to 1e-6): the mesh
/// would look the same without normals, and a kernel need not interpolate them.
[[nodiscard]] bool has_flat_normals(const Mesh& mesh);

} // namespace plumb
