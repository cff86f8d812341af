#include "accel/sah/small_range.h"

#include "accel/sah/sah_cost.h"
#include "accel/sah/sah_view.h"

#include <algorithm>
#include <array>
#include <bit>

namespace plumb {
namespace {

using Index = std::uint8_t;
using IndexSet = std::uint64_t;

/// leaf_cost as a table.
constexpr std::array<float, small_range_size + 1> cost_of = [] {
    std::array<float, small_range_size + 1> table{};
    for (std::size_t n = 0; n < table.size(); ++n)
        table[n] = static_cast<float>(leaf_cost(n));
    return table;
}();

/// A split of a list of `axis` after its first `left_count` entries.
struct ListSplit {
    int axis = 0;
    std::uint32_t left_count = 0;
    float cost = infinity;
};

/// The primitives stay where they are; what is split are three lists of them, sorted by centroid
/// along each axis.
class SmallRange {
  public:
    SmallRange(const BuildContext& context, std::span<const PrimitiveRef> refs, TreePiece& piece)
        : context_(context), piece_(piece), count_(static_cast<std::uint32_t>(refs.size())) {
        alignas(16) float centroids[small_range_size][4];
        for (std::size_t i = 0; i < refs.size(); ++i) {
            box_[i] = refs[i].box();
            number_[i] = refs[i].number;
            if (number_[i] >= context.first_sphere)
                spheres_ |= IndexSet{1} << i;
            float4::store(centroids[i], centroid(box_[i]));
        }
        for (int axis = 0; axis < 3; ++axis)
            sort(axis, centroids);
    }

    void build(std::size_t node, int depth) { build(node, 0, count_, depth); }

  private:
    /// The rank of each is the number of those before it, ties by index: no branch is guessed.
    void sort(int axis, const float (&centroids)[small_range_size][4]) {
        constexpr std::uint32_t step = 16;
        alignas(64) float key[small_range_size];
        const std::uint32_t padded = (count_ + step - 1) / step * step;
        for (std::uint32_t i = 0; i < padded; ++i)
            key[i] = i < count_ ? centroids[i][axis] : infinity;
        for (std::uint32_t i = 0; i < count_; ++i) {
            std::uint32_t rank = 0;
            for (std::uint32_t j = 0; j < padded; ++j)
                rank += (key[j] < key[i] ? 1u : 0u) + (key[j] == key[i] && j < i ? 1u : 0u);
            order_[axis][rank] = static_cast<Index>(i);
        }
    }

    void build(std::size_t node, std::uint32_t begin, std::uint32_t end, int depth) {
        const std::uint32_t count = end - begin;
        if (count <= sah_max_leaf_size) {
            const IndexSet members = set_of(0, begin, end);
            const IndexSet spheres = members & spheres_;
            if (spheres != 0 && spheres != members)
                return split(node, begin, end, members & ~spheres, depth);
            if (count == 1 || must_halve(count, depth) || !split_pays(node, begin, end, depth))
                make_leaf(node, begin, end, depth);
            return;
        }
        ListSplit best = must_halve(count, depth) ? halving(begin, end) : best_split(begin, end);
        split(node, begin, end, set_of(best.axis, begin, begin + best.left_count), depth);
    }

    /// Splits what could be a leaf if that is cheaper; whether it was.
    bool split_pays(std::size_t node, std::uint32_t begin, std::uint32_t end, int depth) {
        const ListSplit best = best_split(begin, end);
        const float area = union_of(begin, end).half_area(context_.area_scale);
        if (context_.traversal_cost * area + best.cost >= cost_of[end - begin] * area)
            return false;
        split(node, begin, end, set_of(best.axis, begin, begin + best.left_count), depth);
        return true;
    }

    [[nodiscard]] ListSplit best_split(std::uint32_t begin, std::uint32_t end) const {
        ListSplit best;
        const std::uint32_t count = end - begin;
        float right_cost[small_range_size];
        for (int axis = 0; axis < 3; ++axis) {
            const Index* list = order_[axis] + begin;
            Box box;
            for (std::uint32_t i = count - 1; i > 0; --i) {
                box.extend(box_[list[i]]);
                right_cost[i] = box.half_area(context_.area_scale) * cost_of[count - i];
            }
            box = {};
            for (std::uint32_t i = 1; i < count; ++i) {
                box.extend(box_[list[i - 1]]);
                const float cost = box.half_area(context_.area_scale) * cost_of[i] + right_cost[i];
                if (cost < best.cost)
                    best = {axis, i, cost};
            }
        }
        return best;
    }

    /// By count, along the longest axis of the box.
    [[nodiscard]] ListSplit halving(std::uint32_t begin, std::uint32_t end) const {
        const Vec3 extent = union_of(begin, end).bounds().extent();
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                         : extent.y >= extent.z                       ? 1
                                                                      : 2;
        return {axis, (end - begin) / 2, 0};
    }

    /// Orders the three lists so that the members of `left` come first, and builds both sides.
    void split(std::size_t node, std::uint32_t begin, std::uint32_t end, IndexSet left, int depth) {
        const auto middle = begin + static_cast<std::uint32_t>(std::popcount(left));
        for (Index* list : {order_[0], order_[1], order_[2]}) {
            Index right_side[small_range_size + 1];
            std::uint32_t l = begin, r = 0;
            for (std::uint32_t i = begin; i < end; ++i) {
                const Index index = list[i];
                const auto goes_left = static_cast<std::uint32_t>((left >> index) & 1);
                list[l] = right_side[r] = index;
                l += goes_left;
                r += 1 - goes_left;
            }
            std::copy_n(right_side, r, list + middle);
        }
        const std::uint32_t children = piece_.add_pair();
        piece_.nodes[node].first = children;
        piece_.nodes[node].count = 0;
        piece_.nodes[children].bounds = union_of(begin, middle).bounds();
        piece_.nodes[children + 1].bounds = union_of(middle, end).bounds();
        build(children, begin, middle, depth + 1);
        build(children + 1, middle, end, depth + 1);
    }

    void make_leaf(std::size_t node, std::uint32_t begin, std::uint32_t end, int depth) {
        const std::size_t first = piece_.primitives.size();
        for (std::uint32_t i = begin; i < end; ++i)
            piece_.primitives.push_back(number_[order_[0][i]]);
        const auto list = piece_.primitives.begin() + static_cast<std::ptrdiff_t>(first);
        std::sort(list, piece_.primitives.end());
        // Two parts of one triangle are one again.
        piece_.primitives.erase(std::unique(list, piece_.primitives.end()),
                                piece_.primitives.end());
        piece_.nodes[node].first = static_cast<std::uint32_t>(first);
        piece_.nodes[node].count = static_cast<std::uint32_t>(piece_.primitives.size() - first);
        piece_.depth = std::max(piece_.depth, depth);
    }

    [[nodiscard]] IndexSet set_of(int axis, std::uint32_t begin, std::uint32_t end) const {
        IndexSet set = 0;
        for (std::uint32_t i = begin; i < end; ++i)
            set |= IndexSet{1} << order_[axis][i];
        return set;
    }
    [[nodiscard]] Box union_of(std::uint32_t begin, std::uint32_t end) const {
        Box box;
        for (std::uint32_t i = begin; i < end; ++i)
            box.extend(box_[order_[0][i]]);
        return box;
    }

    const BuildContext& context_;
    TreePiece& piece_;
    std::uint32_t count_;
    IndexSet spheres_ = 0;
    std::array<Box, small_range_size> box_;
    PrimitiveNumber number_[small_range_size];
    Index order_[3][small_range_size];
};

} // namespace

bool must_halve(std::size_t count, int depth) {
    return depth + static_cast<int>(std::bit_width(count - 1)) + 1 >= sah_max_depth;
}

void build_small_range(const BuildContext& context, std::span<const PrimitiveRef> refs,
                       std::size_t node, int depth, TreePiece& piece) {
    SmallRange(context, refs, piece).build(node, depth);
}

} // namespace plumb
