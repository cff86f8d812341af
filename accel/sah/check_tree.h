/// \file  Checks the invariants of a SAH tree; for tests.
#pragma once

#include "accel/sah/sah_view.h"

#include <string>

namespace plumb {

/// Every traceable primitive in exactly one leaf, as it is in the geometry; every box containing
/// the boxes and primitives below it; depth and leaf size within their bounds; every node and
/// block used once. Returns what is wrong first, or nothing.
[[nodiscard]] std::string check_tree(const SahView& tree, const GeometryView& geometry);

} // namespace plumb
