/// \file  The binary tree that the builder makes and the layouts are made from. Host only.
#pragma once

#include "accel/geometry.h"

#include <vector>

namespace plumb {

/// Primitives are numbered through: the triangles of mesh 0, of mesh 1, ..., then the spheres. So
/// the lower number is the lower (geometry, primitive).
using PrimitiveNumber = std::uint32_t;

struct BinaryNode {
    Bounds bounds;
    std::uint32_t first = 0; ///< inner: index of the left child, the right one is next; leaf: into
                             ///< BinaryBvh::primitives
    std::uint32_t count = 0; ///< 0: inner; else the number of primitives of the leaf

    [[nodiscard]] bool is_leaf() const { return count != 0; }
};
static_assert(sizeof(BinaryNode) == 32);

/// nodes[0] is the root; no nodes where nothing is traceable. A parent's box contains its
/// children's. A leaf holds up to sah_max_leaf_size triangles or spheres, not both. With spatial
/// splits a triangle can be in several leaves, at most once in each, and the union of their boxes
/// contains every point at which a ray can meet it.
struct BinaryBvh {
    std::vector<BinaryNode> nodes;
    std::vector<PrimitiveNumber> primitives; ///< the leaves', each leaf's in ascending order
    std::size_t primitive_count = 0, skipped_count = 0;
    int depth = 0; ///< of the deepest leaf, the root being 0
};

} // namespace plumb
