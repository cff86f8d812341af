#include "accel/sah/split_leaves.h"

#include "accel/sah/primitive_ref.h"
#include "accel/sah/sah_view.h"

#include <algorithm>
#include <array>

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
        for (std::size_t i = 0; i < count; ++i) {
            const BinaryNode leaf = tree_.nodes[i];
            if (leaf.count < 2)
                continue;
            size_ = leaf.count;
            for (std::uint32_t k = 0; k < size_; ++k) {
                const PrimitiveNumber number = tree_.primitives[leaf.first + k];
                const PrimitiveNumbers::Id id = numbers_.id(number);
                const Bounds own = primitive_bounds(geometry_, id.geometry, id.primitive);
                members_[k] = {
                    number, {max(own.lower, leaf.bounds.lower), min(own.upper, leaf.bounds.upper)}};
            }
            split(i, std::span(members_).first(size_), leaf.first);
        }
    }

  private:
    static Bounds box_of(std::span<const Member> members) {
        Bounds box;
        for (const Member& member : members)
            box.extend(member.bounds);
        return box;
    }

    static void sort(std::span<Member> members, int axis) {
        std::sort(members.begin(), members.end(), [axis](const Member& a, const Member& b) {
            const float ca = a.bounds.center()[axis], cb = b.bounds.center()[axis];
            return ca < cb || (ca == cb && a.number < b.number);
        });
    }

    /// How many of the sorted members go left, and the cost.
    static std::pair<std::size_t, double> best_position(std::span<const Member> members) {
        std::size_t best = members.size() / 2;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 1; i < members.size(); ++i) {
            const double cost =
                surface_area(box_of(members.first(i))) * static_cast<double>(i) +
                surface_area(box_of(members.subspan(i))) * static_cast<double>(members.size() - i);
            if (cost < least) {
                least = cost;
                best = i;
            }
        }
        return {best, least};
    }

    /// `first`: where the members stand in tree_.primitives.
    void split(std::size_t node, std::span<Member> members, std::uint32_t first) {
        if (members.size() == 1) {
            tree_.nodes[node].first = first;
            tree_.nodes[node].count = 1;
            tree_.primitives[first] = members[0].number;
            return;
        }
        int best_axis = 0;
        double least = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            sort(members, axis);
            if (const double cost = best_position(members).second; cost < least) {
                least = cost;
                best_axis = axis;
            }
        }
        sort(members, best_axis);
        const std::size_t middle = best_position(members).first;
        const auto children = static_cast<std::uint32_t>(tree_.nodes.size());
        tree_.nodes[node].first = children;
        tree_.nodes[node].count = 0;
        const auto left = members.first(middle), right = members.subspan(middle);
        tree_.nodes.push_back({box_of(left), 0, 0});
        tree_.nodes.push_back({box_of(right), 0, 0});
        split(children, left, first);
        split(children + 1, right, first + static_cast<std::uint32_t>(middle));
    }

    BinaryBvh& tree_;
    const GeometryView& geometry_;
    const PrimitiveNumbers numbers_;
    std::array<Member, sah_max_leaf_size> members_;
    std::size_t size_ = 0;
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
