/// \file  The binary SAH tree as kernels on a device read it.
#pragma once

#include "accel/intersector.h"
#include "accel/sah/sah_view.h"

#include <vector>

namespace plumb {

/// The arrays a SahView looks at, and what was counted while building.
struct SahTree {
    std::vector<SahNode> nodes; ///< never empty
    std::vector<TriangleBlock> blocks;
    std::vector<SahSphere> spheres;
    std::uint32_t sphere_geometry = 0;

    std::size_t primitive_count = 0, skipped_count = 0;
    std::size_t leaf_count = 0, inner_count = 0; ///< a tree of one leaf has no inner node
    int depth = 0;                               ///< of the deepest leaf, the root being 0
    double sah_cost = 0; ///< C_t = C_i = 1, relative to the root's area; 0 where that is 0

    double build_s = 0;

    [[nodiscard]] AccelStats stats() const;
    /// Valid until the tree is changed or moved.
    [[nodiscard]] SahView view() const;
};

/// Binned SAH over all traceable primitives; leaves hold up to sah_max_leaf_size triangles or
/// spheres, no leaf lies deeper than sah_max_depth. Deterministic. Throws std::bad_alloc where
/// memory ends and std::runtime_error above 2^31 primitives. `threads`: 0 for all cores.
[[nodiscard]] SahTree build_sah(const GeometryView& geometry, int threads = 0);

} // namespace plumb
