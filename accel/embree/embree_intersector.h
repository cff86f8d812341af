/// \file  Embree as an Intersector. No Embree type appears here.
#pragma once

#include "accel/embree/embree_options.h"

namespace plumb {

/// Embree over all meshes, spheres as user geometry with intersect_sphere. Of several hits at the
/// same t Embree's own order decides. Throws std::runtime_error where Embree reports an error and
/// for a packet width that is neither 1 nor 16, std::bad_alloc where memory ends.
[[nodiscard]] std::unique_ptr<Intersector> make_embree_intersector(const GeometryView& geometry,
                                                                   const EmbreeOptions& options);

/// Robust, single rays, the quality and threads of `options`. Throws std::runtime_error also for
/// any triangle test but the watertight one.
[[nodiscard]] std::unique_ptr<Intersector> make_embree_intersector(const GeometryView& geometry,
                                                                   const BuildOptions& options);

} // namespace plumb
