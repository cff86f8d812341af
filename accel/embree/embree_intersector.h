/// \file  Embree as an Intersector. No Embree type appears here.
#pragma once

#include "accel/intersector.h"

namespace plumb {

/// Embree's robust scene over all meshes, spheres as user geometry with intersect_sphere. Of
/// several hits at the same t Embree's own order decides. Throws std::runtime_error where Embree
/// reports an error and for any triangle test but the watertight one, std::bad_alloc where memory
/// ends.
[[nodiscard]] std::unique_ptr<Intersector> make_embree_intersector(const GeometryView& geometry,
                                                                   const BuildOptions& options);

} // namespace plumb
