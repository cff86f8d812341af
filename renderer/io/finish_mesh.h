/// \file  The last step of every mesh reader: what no renderer wants to meet later.
#pragma once

#include "renderer/scene/scene.h"

#include <cstddef>
#include <string>
#include <vector>

namespace plumb {

/// Drops triangles with a repeated vertex or without area; makes the normals unit vectors, with
/// that of compute_normals where one is zero; turns triangles over whose winding disagrees with
/// their vertex normals, so that the front is on the side of the normals, as Mitsuba shades it.
/// One warning for each, with the count, and one if no triangle is left. Indices must be in range
/// and coordinates finite.
/// \param file        for the warnings
/// \param degenerate  triangles that the reader dropped already
void finish_mesh(Mesh& mesh, const std::string& file, std::size_t degenerate,
                 std::vector<std::string>& warnings);

} // namespace plumb
