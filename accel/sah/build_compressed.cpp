#include "accel/sah/build_compressed.h"

#include "accel/sah/build_binary.h"
#include "accel/sah/compress_node.h"
#include "accel/sah/primitive_ref.h"
#include "accel/sah/split_leaves.h"
#include "accel/sah/wide_plan.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace plumb {
namespace {

/// Costs of the paper: a node 1, a primitive 0.3.
constexpr WideCosts compressed_costs{0, 0.3, compressed_max_leaf};

/// Writes planned nodes in the order in which a traversal numbers them: the children of a node
/// side by side.
class Compressor {
  public:
    Compressor(const BinaryBvh& binary, const GeometryView& geometry, const WidePlan& plan,
               CompressedTree& tree)
        : binary_(binary), geometry_(geometry), plan_(plan), numbers_(geometry), tree_(tree) {}

    void run() {
        tree_.nodes.reserve(std::max<std::size_t>(plan_.nodes.size(), 1));
        tree_.primitives.reserve(binary_.primitives.size());
        tree_.nodes.emplace_back();
        if (plan_.nodes.empty()) {
            CompressedNode& root = tree_.nodes[0];
            root = {};
            quantize({}, boxes_, 0, root);
            return;
        }
        write(0, 0, 0);
        const Bounds& root = binary_.nodes[0].bounds;
        tree_.reach = max(max_component(abs(root.lower)), max_component(abs(root.upper)));
        const double area = surface_area(root);
        tree_.sah_cost = area > 0 ? cost_ / area : 0;
        tree_.primitives.shrink_to_fit();
    }

  private:
    /// Writes a planned node at `index` and all below it.
    void write(const std::uint32_t planned, std::size_t index, int depth) {
        if (depth >= compressed_max_depth)
            throw std::runtime_error("sah: the compressed tree is too deep");
        const PlannedNode& from = plan_.nodes[planned];
        std::array<Bounds, compressed_width> boxes;
        Bounds whole;
        for (std::uint32_t i = 0; i < from.count; ++i) {
            boxes[i] = binary_.nodes[from.child[i]].bounds;
            whole.extend(boxes[i]);
        }
        cost_ += surface_area(whole);
        const auto slots = assign_slots(std::span(boxes).first(from.count));
        std::array<std::uint32_t, compressed_width> child_of{};
        std::uint32_t used = 0;
        for (std::uint32_t i = 0; i < from.count; ++i) {
            used |= 1u << slots[i];
            child_of[slots[i]] = i;
            boxes_[slots[i]] = boxes[i];
        }
        CompressedNode node{};
        quantize(whole, boxes_, used, node);
        node.first_child = static_cast<std::uint32_t>(tree_.nodes.size());
        node.first_primitive = static_cast<std::uint32_t>(tree_.primitives.size());
        std::array<std::uint32_t, compressed_width> below{}; // planned nodes, in order of slots
        std::size_t below_count = 0;
        for (std::uint32_t slot = 0; slot < compressed_width; ++slot) {
            if ((used >> slot & 1u) == 0)
                continue;
            const std::uint32_t i = child_of[slot];
            std::uint32_t meta = 1u << 5 | (24 + slot);
            if (from.inner[i] != 0) {
                node.exponents |= 1u << (24 + slot);
                below[below_count++] = from.inner[i];
            } else {
                meta = append_leaf(from.child[i], node.first_primitive);
                tree_.depth = std::max(tree_.depth, depth + 1);
            }
            node.meta[slot / 4] |= meta << (8 * (slot % 4));
        }
        tree_.nodes.resize(tree_.nodes.size() + below_count);
        tree_.nodes[index] = node;
        for (std::size_t i = 0; i < below_count; ++i)
            write(below[i], node.first_child + i, depth + 1);
    }

    /// Appends the primitives below a binary node; returns the leaf's meta byte.
    std::uint32_t append_leaf(std::uint32_t binary_node, std::uint32_t first_primitive) {
        const auto before = static_cast<std::uint32_t>(tree_.primitives.size()) - first_primitive;
        members_.clear();
        append_primitives(binary_, binary_node, members_);
        std::sort(members_.begin(), members_.end());
        for (const PrimitiveNumber number : members_)
            append_primitive(number);
        ++tree_.leaf_count;
        cost_ +=
            surface_area(binary_.nodes[binary_node].bounds) * static_cast<double>(members_.size());
        const std::uint32_t ones = (1u << members_.size()) - 1;
        return ones << 5 | before;
    }

    void append_primitive(PrimitiveNumber number) {
        const PrimitiveNumbers::Id id = numbers_.id(number);
        if (geometry_.is_sphere(id.geometry)) {
            const Sphere& s = geometry_.spheres[id.primitive];
            tree_.primitives.push_back(
                {s.center, id.geometry, {s.radius, 0, 0}, id.primitive, {}, 1});
            return;
        }
        const TriangleVertices t = geometry_.vertices(id.geometry, id.primitive);
        tree_.primitives.push_back({t.a, id.geometry, t.b, id.primitive, t.c, 0});
    }

    const BinaryBvh& binary_;
    const GeometryView& geometry_;
    const WidePlan& plan_;
    const PrimitiveNumbers numbers_;
    CompressedTree& tree_;
    std::array<Bounds, compressed_width> boxes_{}; ///< of the node in work, by slot
    std::vector<PrimitiveNumber> members_;
    double cost_ = 0;
};

} // namespace

CompressedView CompressedTree::view() const {
    CompressedView view;
    view.nodes = nodes.data();
    view.primitives = primitives.data();
    view.node_count = static_cast<std::uint32_t>(nodes.size());
    view.primitive_count = static_cast<std::uint32_t>(primitives.size());
    view.reach = reach;
    return view;
}

AccelStats CompressedTree::stats() const {
    AccelStats stats;
    stats.build_s = build_s;
    stats.bytes =
        nodes.size() * sizeof(CompressedNode) + primitives.size() * sizeof(CompressedPrimitive);
    stats.node_count = (leaf_count > 0 ? nodes.size() : 0) + leaf_count;
    stats.leaf_count = leaf_count;
    stats.primitive_count = primitive_count;
    stats.skipped_count = skipped_count;
    stats.depth = depth;
    stats.sah_cost = sah_cost;
    return stats;
}

CompressedTree build_compressed(const GeometryView& geometry, int threads) {
    const auto start = std::chrono::steady_clock::now();
    CompressedTree tree;
    const BinaryBvh binary =
        split_leaves(build_binary(geometry, {BuildQuality::medium, threads}), geometry);
    const WidePlan plan =
        plan_wide(binary, PrimitiveNumbers(geometry).first_sphere(), compressed_costs);
    Compressor(binary, geometry, plan, tree).run();
    tree.primitive_count = binary.primitive_count;
    tree.skipped_count = binary.skipped_count;
    tree.build_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return tree;
}

} // namespace plumb
