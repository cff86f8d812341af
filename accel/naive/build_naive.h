/// \file  Builds the naive BVH: median split by count along the longest axis, recursively.
#pragma once

#include "accel/geometry.h"

#include <vector>

namespace plumb {

/// One node of the naive tree: an inner node with two children, or a leaf with one primitive.
struct NaiveNode {
    Bounds bounds;
    std::uint32_t left = 0, right = 0; ///< node indices; both 0 in a leaf (0 is the root)
    std::uint32_t geometry = invalid_id, primitive = invalid_id; ///< of a leaf

    [[nodiscard]] bool is_leaf() const { return right == 0; }
};

/// A binary tree over every traceable primitive; nodes[0] is the root. No nodes: nothing to hit.
/// Its depth is ceil(log2(primitive count)).
struct NaiveTree {
    std::vector<NaiveNode> nodes;
    std::size_t skipped_count = 0; ///< primitives that are not traceable
};

/// Deterministic: equal centroids are ordered by id. Throws std::bad_alloc where memory ends and
/// std::runtime_error above 2^31 primitives.
[[nodiscard]] NaiveTree build_naive(const GeometryView& geometry);

} // namespace plumb
