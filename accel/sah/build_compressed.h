/// \file  The compressed 8-wide tree as kernels on a device read it, made of the SAH build.
#pragma once

#include "accel/intersector.h"
#include "accel/sah/compressed_view.h"

#include <vector>

namespace plumb {

/// The arrays a CompressedView looks at, and what was counted while building.
struct CompressedTree {
    std::vector<CompressedNode> nodes; ///< never empty
    std::vector<CompressedPrimitive> primitives;
    float reach = 0;

    std::size_t primitive_count = 0, skipped_count = 0, leaf_count = 0;
    int depth = 0;       ///< of the deepest leaf, the root being 0
    double sah_cost = 0; ///< of the boxes before they were rounded, as in AccelStats

    double build_s = 0;

    [[nodiscard]] AccelStats stats() const;
    /// Valid until the tree is changed or moved.
    [[nodiscard]] CompressedView view() const;
};

/// The binary tree of build_binary (medium), its leaves split to single primitives, collapsed by
/// the plan of plan_wide with leaves of up to compressed_max_leaf. Deterministic. Throws
/// std::bad_alloc where memory ends and std::runtime_error above 2^31 primitives or a depth of
/// compressed_max_depth. `threads`: 0 for all cores.
[[nodiscard]] CompressedTree build_compressed(const GeometryView& geometry, int threads = 0);

} // namespace plumb
