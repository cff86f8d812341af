/// \file  Which binary nodes become the children of which wide node.
#pragma once

#include "accel/sah/wide_bvh.h"

#include <array>
#include <span>

namespace plumb {

/// Costs of the surface area heuristic for the wide tree, in units of one node visited, and what a
/// leaf may hold. These are the CPU's, where a leaf is a block of eight lanes.
struct WideCosts {
    double leaf = 2;        ///< a leaf as such
    double primitive = 0.1; ///< each primitive of a leaf
    std::uint32_t max_leaf = wide_width;
};

/// One wide node to be.
struct PlannedNode {
    std::array<std::uint32_t, wide_width> child; ///< binary nodes
    std::array<std::uint32_t, wide_width>
        inner;               ///< index of their own plan; 0: the child is a leaf
    std::uint32_t count = 0; ///< children
    std::uint32_t unit = 0;  ///< where the node lies; its leaves follow it
};

struct WidePlan {
    std::vector<PlannedNode> nodes; ///< depth first; nodes[0] is the root; none in an empty tree
    std::size_t units = 0;          ///< of the whole tree
    std::size_t leaf_count = 0;
    int depth = 0; ///< of the deepest leaf, the root being 0
};

/// Whether the primitives of a leaf are spheres; `first_sphere` is the number of the first one.
[[nodiscard]] inline bool is_sphere_leaf(const BinaryBvh& tree, const BinaryNode& leaf,
                                         PrimitiveNumber first_sphere) {
    return tree.primitives[leaf.first] >= first_sphere;
}

/// Appends the numbers of all primitives below a node.
void append_primitives(const BinaryBvh& tree, std::uint32_t node,
                       std::vector<PrimitiveNumber>& numbers);

/// Leaves of `tree` must hold no more than costs.max_leaf.
[[nodiscard]] WidePlan plan_wide(const BinaryBvh& tree, PrimitiveNumber first_sphere,
                                 const WideCosts& costs = {});

} // namespace plumb
