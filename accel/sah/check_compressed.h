/// \file  Checks the invariants of a compressed tree; for tests.
#pragma once

#include "accel/sah/compressed_view.h"

#include <string>

namespace plumb {

/// Every traceable primitive in exactly one leaf, as it is in the geometry; every decoded box
/// containing all primitives below it; slots, counts and offsets as compressed_view.h says; every
/// node and primitive reached once. Returns what is wrong first, or nothing.
[[nodiscard]] std::string check_compressed(const CompressedView& tree,
                                           const GeometryView& geometry);

} // namespace plumb
