#include "accel/sah/split_leaves.h"

#include "accel/sah/primitive_ref.h"
#include "accel/sah/sah_view.h"

#include <algorithm>
#include <array>
#include <limits>

namespace plumb {
namespace {

struct Member {
    PrimitiveNumber number;
    Bounds bounds;
};

/// Splits the leaves of one tree. Each stays within its box: with spatial splits that is smaller
/// than its primitives'.
class LeafSplitter {
  public:
    LeafSplitter(BinaryBvh& tree, const GeometryView& geometry)
        : tree_(tree), geometry_(geometry), numbers_(geometry) {}

    void run() {
        const std::size_t count = tree_.nodes.size();
        tree_.nodes.reserve(2 * tree_.primitives.size());
        for (std::size_t i = 0; i < count; ++i) {
            const BinaryNode leaf = tree_.nodes[i];
            if (leaf.count < 2)
                continue;
            for (std::uint32_t k = 0; k < leaf.count; ++k) {
                const PrimitiveNumber number = tree_.primitives[leaf.first + k];
                const PrimitiveNumbers::Id id = numbers_.id(number);
                const Bounds own = primitive_bounds(geometry_, id.geometry, id.primitive);
                members_[k] = {
                    number, {max(own.lower, leaf.bounds.lower), min(own.upper, leaf.bounds.upper)}};
            }
            split(i, std::span(members_).first(leaf.count), leaf.first);
        }
    }

  private:
    /// By centroid, ties by number; by insertion, of eight at most.
    static void sort(std::span<Member> members, int axis) {
        const auto before = [axis](const Member& a, const Member& b) {
            const float ca = a.bounds.lower[axis] + a.bounds.upper[axis];
            const float cb = b.bounds.lower[axis] + b.bounds.upper[axis];
            return ca < cb || (ca == cb && a.number < b.number);
        };
        for (std::size_t i = 1; i < members.size(); ++i) {
            const Member member = members[i];
            std::size_t to = i;
            for (; to > 0 && before(member, members[to - 1]); --to)
                members[to] = members[to - 1];
            members[to] = member;
        }
    }

    /// The cheapest position of a sorted list, with the boxes of both sides.
    struct Split {
        double cost = std::numeric_limits<double>::infinity();
        std::size_t middle = 0;
        Bounds left, right;
    };
    static Split best_split(std::span<const Member> members) {
        std::array<Bounds, sah_max_leaf_size> from; ///< [i]: box of members i and after
        Bounds box;
        for (std::size_t i = members.size(); i-- > 0;) {
            box.extend(members[i].bounds);
            from[i] = box;
        }
        Split best;
        box = {};
        for (std::size_t i = 1; i < members.size(); ++i) {
            box.extend(members[i - 1].bounds);
            const double cost = surface_area(box) * static_cast<double>(i) +
                                surface_area(from[i]) * static_cast<double>(members.size() - i);
            if (cost < best.cost)
                best = {cost, i, box, from[i]};
        }
        return best;
    }

    /// `first`: where the members stand in tree_.primitives.
    void split(std::size_t node, std::span<Member> members, std::uint32_t first) {
        if (members.size() == 1) {
            tree_.nodes[node].first = first;
            tree_.nodes[node].count = 1;
            tree_.primitives[first] = members[0].number;
            return;
        }
        Split best;
        std::array<Member, sah_max_leaf_size> order, best_order;
        std::copy(members.begin(), members.end(), order.begin());
        const std::span<Member> ordered = std::span(order).first(members.size());
        for (int axis = 0; axis < 3; ++axis) {
            sort(ordered, axis);
            if (const Split found = best_split(ordered); found.cost < best.cost) {
                best = found;
                best_order = order;
            }
        }
        std::copy_n(best_order.begin(), members.size(), members.begin());
        const std::size_t middle = best.middle;
        const auto children = static_cast<std::uint32_t>(tree_.nodes.size());
        tree_.nodes[node].first = children;
        tree_.nodes[node].count = 0;
        const auto left = members.first(middle), right = members.subspan(middle);
        tree_.nodes.push_back({best.left, 0, 0});
        tree_.nodes.push_back({best.right, 0, 0});
        split(children, left, first);
        split(children + 1, right, first + static_cast<std::uint32_t>(middle));
    }

    BinaryBvh& tree_;
    const GeometryView& geometry_;
    const PrimitiveNumbers numbers_;
    std::array<Member, sah_max_leaf_size> members_;
};

int depth_of(const BinaryBvh& tree, std::uint32_t node) {
    const BinaryNode& n = tree.nodes[node];
    return n.is_leaf() ? 0 : 1 + std::max(depth_of(tree, n.first), depth_of(tree, n.first + 1));
}

} // namespace

BinaryBvh split_leaves(BinaryBvh tree, const GeometryView& geometry) {
    LeafSplitter(tree, geometry).run();
    tree.depth = tree.nodes.empty() ? 0 : depth_of(tree, 0);
    return tree;
}

} // namespace plumb
