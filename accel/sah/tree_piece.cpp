#include "accel/sah/tree_piece.h"

#include <algorithm>

namespace plumb {
namespace {

/// A piece and what its indices become: the node i > 0 stands at node_base + i.
struct Placed {
    TreePiece* piece;
    std::size_t node_base, primitive_base;
    std::size_t root; ///< where its node 0 stands
};

struct Placement {
    std::vector<Placed> pieces;
    std::size_t nodes = 1, primitives = 0;
    int depth = 0;

    /// In depth-first order the last branch of a piece comes first after it.
    void add(TreePiece& piece, std::size_t root) {
        const std::size_t base = nodes - 1;
        pieces.push_back({&piece, base, primitives, root});
        nodes += piece.nodes.size() - 1;
        primitives += piece.primitives.size();
        depth = std::max(depth, piece.depth);
        for (std::size_t i = piece.branches.size(); i-- > 0;)
            add(*piece.branches[i].piece, base + piece.branches[i].node);
    }
};

BinaryNode moved(BinaryNode node, const Placed& placed) {
    node.first +=
        static_cast<std::uint32_t>(node.is_leaf() ? placed.primitive_base : placed.node_base);
    return node;
}

} // namespace

BinaryBvh assemble(TreePiece& root, const Workers& workers) {
    BinaryBvh tree;
    if (root.branches.empty()) {
        tree.nodes = std::move(root.nodes);
        tree.primitives = std::move(root.primitives);
        tree.depth = root.depth;
        return tree;
    }
    Placement placement;
    placement.add(root, 0);
    tree.depth = placement.depth;
    tree.nodes.resize(placement.nodes);
    tree.primitives.resize(placement.primitives);
    workers.for_each(placement.pieces.size(), [&](std::size_t i) {
        const Placed& placed = placement.pieces[i];
        const TreePiece& piece = *placed.piece;
        for (std::size_t n = 1; n < piece.nodes.size(); ++n)
            tree.nodes[placed.node_base + n] = moved(piece.nodes[n], placed);
        std::copy(piece.primitives.begin(), piece.primitives.end(),
                  tree.primitives.begin() + static_cast<std::ptrdiff_t>(placed.primitive_base));
    });
    for (const Placed& placed : placement.pieces)
        tree.nodes[placed.root] = moved(placed.piece->nodes[0], placed);
    return tree;
}

} // namespace plumb
