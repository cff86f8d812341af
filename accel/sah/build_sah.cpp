#include "accel/sah/build_sah.h"

#include "accel/sah/build_binary.h"
#include "accel/sah/primitive_ref.h"

#include <algorithm>
#include <chrono>

namespace plumb {
namespace {

/// Writes a BinaryBvh in the layout of a SahView.
class Flattener {
  public:
    Flattener(const GeometryView& geometry, const BinaryBvh& binary, SahTree& tree)
        : geometry_(geometry), binary_(binary), numbers_(geometry), tree_(tree) {}

    void run() {
        tree_.primitive_count = binary_.primitive_count;
        tree_.skipped_count = binary_.skipped_count;
        tree_.sphere_geometry = geometry_.sphere_geometry();
        tree_.depth = binary_.depth;
        tree_.nodes.reserve(binary_.nodes.size() / 2 + 1);
        tree_.blocks.reserve(binary_.nodes.size() / 2 + 1);
        const bool empty = binary_.nodes.empty();
        const ChildRef root = empty ? ChildRef::triangle_leaf(0, 0) : append(binary_.nodes[0]);
        if (root.is_leaf()) {
            // nodes[0] is a node always, which spares every ray a question.
            SahNode& node = tree_.nodes.emplace_back();
            set_child(node, 0, empty ? Bounds{} : binary_.nodes[0].bounds, root);
            set_child(node, 1, Bounds{}, ChildRef::triangle_leaf(0, 0));
        }
        tree_.nodes.shrink_to_fit();
        tree_.blocks.shrink_to_fit();
        tree_.spheres.shrink_to_fit();
        const double root_area = empty ? 0 : surface_area(binary_.nodes[0].bounds);
        tree_.sah_cost = root_area > 0 ? cost_ / root_area : 0;
    }

  private:
    static void set_child(SahNode& node, int i, const Bounds& bounds, ChildRef child) {
        for (int axis = 0; axis < 3; ++axis) {
            node.planes[axis][i] = bounds.lower[axis];
            node.planes[axis][2 + i] = bounds.upper[axis];
        }
        node.child[i] = child;
    }

    /// Appends a subtree.
    ChildRef append(const BinaryNode& from) {
        if (from.is_leaf())
            return append_leaf(from);
        ++tree_.inner_count;
        cost_ += surface_area(from.bounds);
        const std::size_t index = tree_.nodes.size();
        tree_.nodes.emplace_back();
        for (int i = 0; i < 2; ++i) {
            const BinaryNode& half = binary_.nodes[from.first + static_cast<std::uint32_t>(i)];
            const ChildRef child = append(half);
            set_child(tree_.nodes[index], i, half.bounds, child);
        }
        return ChildRef::node(static_cast<std::uint32_t>(index));
    }

    ChildRef append_leaf(const BinaryNode& leaf) {
        ++tree_.leaf_count;
        cost_ += surface_area(leaf.bounds) * leaf.count;
        const PrimitiveNumber* primitives = &binary_.primitives[leaf.first];
        if (primitives[0] >= numbers_.first_sphere()) {
            const auto first = static_cast<std::uint32_t>(tree_.spheres.size());
            for (std::uint32_t i = 0; i < leaf.count; ++i) {
                const std::uint32_t sphere = primitives[i] - numbers_.first_sphere();
                tree_.spheres.push_back({geometry_.spheres[sphere], sphere});
            }
            return ChildRef::sphere_leaf(first, leaf.count);
        }
        const auto first = static_cast<std::uint32_t>(tree_.blocks.size());
        TriangleBlock& block = tree_.blocks.emplace_back();
        for (std::uint32_t lane = 0; lane < leaf.count; ++lane)
            set_lane(block, lane, numbers_.id(primitives[lane]));
        return ChildRef::triangle_leaf(first, leaf.count);
    }

    void set_lane(TriangleBlock& block, std::uint32_t lane, PrimitiveNumbers::Id id) const {
        const TriangleVertices t = geometry_.vertices(id.geometry, id.primitive);
        const Vec3 corners[3]{t.a, t.b, t.c};
        for (int i = 0; i < 3; ++i)
            for (int axis = 0; axis < 3; ++axis)
                block.vertex[i][axis][lane] = corners[i][axis];
        block.geometry[lane] = id.geometry;
        block.primitive[lane] = id.primitive;
    }

    const GeometryView& geometry_;
    const BinaryBvh& binary_;
    const PrimitiveNumbers numbers_;
    SahTree& tree_;
    double cost_ = 0;
};

} // namespace

SahView SahTree::view() const {
    SahView view;
    view.nodes = nodes.data();
    view.blocks = blocks.data();
    view.spheres = spheres.data();
    view.node_count = static_cast<std::uint32_t>(nodes.size());
    view.block_count = static_cast<std::uint32_t>(blocks.size());
    view.sphere_count = static_cast<std::uint32_t>(spheres.size());
    view.sphere_geometry = sphere_geometry;
    return view;
}

AccelStats SahTree::stats() const {
    AccelStats stats;
    stats.build_s = build_s;
    stats.bytes = nodes.size() * sizeof(SahNode) + blocks.size() * sizeof(TriangleBlock) +
                  spheres.size() * sizeof(SahSphere);
    stats.node_count = inner_count + leaf_count;
    stats.leaf_count = leaf_count;
    stats.primitive_count = primitive_count;
    stats.skipped_count = skipped_count;
    stats.depth = depth;
    stats.sah_cost = sah_cost;
    return stats;
}

SahTree build_sah(const GeometryView& geometry, int threads) {
    const auto start = std::chrono::steady_clock::now();
    SahTree tree;
    // Without spatial splits: each triangle once.
    const BinaryBvh binary = build_binary(geometry, {BuildQuality::medium, threads});
    Flattener(geometry, binary, tree).run();
    tree.build_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return tree;
}

} // namespace plumb
