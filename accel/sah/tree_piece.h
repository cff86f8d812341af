/// \file  Part of a tree under construction, written by one thread.
#pragma once

#include "accel/parallel/parallel.h"
#include "accel/sah/binary_bvh.h"

#include <memory>

namespace plumb {

/// Nodes in depth-first order, the two children of a node side by side, and the leaves'
/// primitives. nodes[0] is the root of the part. A large right subtree may be a piece of its own,
/// so that another thread can build it; assemble() puts it where it would have been.
struct TreePiece {
    struct Branch {
        std::size_t node; ///< of this piece, left out: the other piece's root goes there
        std::unique_ptr<TreePiece> piece;
    };

    std::vector<BinaryNode> nodes;
    std::vector<PrimitiveNumber> primitives;
    std::vector<Branch> branches; ///< in the order in which they were left out
    int depth = 0;                ///< of the deepest leaf, in the whole tree

    /// A root without children yet, and room for what `primitive_count` primitives usually need.
    TreePiece(const Bounds& bounds, std::size_t primitive_count) {
        nodes.reserve(primitive_count / 2 + 8);
        primitives.reserve(primitive_count);
        nodes.push_back({bounds, 0, 0});
    }
    /// Two nodes side by side; the index of the first.
    [[nodiscard]] std::uint32_t add_pair() {
        nodes.resize(nodes.size() + 2);
        return static_cast<std::uint32_t>(nodes.size() - 2);
    }
};

/// The whole tree: the same whatever was a piece of its own. Empties the pieces.
[[nodiscard]] BinaryBvh assemble(TreePiece& root, const Workers& workers);

} // namespace plumb
