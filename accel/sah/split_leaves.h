/// \file  From leaves made for eight lanes to leaves of one primitive.
#pragma once

#include "accel/sah/binary_bvh.h"

namespace plumb {

/// The same tree with every leaf split down to single primitives, by the surface area heuristic
/// over all positions on three axes; ties by number. What traversals that test one primitive at a
/// time are collapsed from. At most sah_max_leaf_size - 1 levels deeper. Deterministic.
[[nodiscard]] BinaryBvh split_leaves(BinaryBvh tree, const GeometryView& geometry);

} // namespace plumb
