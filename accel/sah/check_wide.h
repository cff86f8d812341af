/// \file  Checks the invariants of the 8-wide tree; for tests.
#pragma once

#include "accel/sah/wide_bvh.h"

#include <string>

namespace plumb {

/// Every traceable primitive in exactly one leaf and no other primitive in any, with the vertices
/// that it has in the geometry; after `spatial_splits` in one leaf at least, at most once in each.
/// The leaves' boxes containing together each primitive's box; a child's box containing all boxes
/// below; children that are not there empty and last; lanes ascending, the last repeated; every
/// unit of the memory used once; depth within wide_max_depth; what was counted. Returns what is
/// wrong first, or nothing.
[[nodiscard]] std::string check_wide(const WideBvh& tree, const GeometryView& geometry,
                                     bool spatial_splits);

} // namespace plumb
