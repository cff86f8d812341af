/// \file  Checks the invariants of a BinaryBvh; for tests.
#pragma once

#include "accel/sah/binary_bvh.h"

#include <string>

namespace plumb {

/// Every traceable primitive in a leaf and no other; each box the union of its children's; the
/// boxes of the leaves that hold a primitive containing together its box and every point of a grid
/// on it; depth, leaf size, order and kinds in leaves as binary_bvh.h says; every node and every
/// place of the list used once. Returns what is wrong first, or nothing.
[[nodiscard]] std::string check_binary(const BinaryBvh& tree, const GeometryView& geometry);

} // namespace plumb
