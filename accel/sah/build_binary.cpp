#include "accel/sah/build_binary.h"

#include "accel/sah/binned_split.h"
#include "accel/sah/reinsertion.h"
#include "accel/sah/small_range.h"
#include "accel/sah/spatial_split.h"

#include <algorithm>
#include <stdexcept>

namespace plumb {
namespace {

/// Below nodes of at least this size the right subtree is a piece of its own where there are
/// threads to build it. The tree does not depend on it.
constexpr std::size_t branch_size = 4096;

/// Spatial splits are tried where the two sides of the best binned split overlap by more of the
/// root's area (Stich et al. 2009, alpha).
constexpr float least_overlap = 1e-5f;

/// ... and by more of the node's own area: a spatial split can save no more than what overlaps. On
/// smooth meshes this spares two thirds of the time and loses nothing.
constexpr float least_shared_part = 0.2f;

/// After so many spatial splits in vain one after the other, those further down are not tried: it
/// is hair or needles, of which no plane cuts few.
constexpr int max_failures = 4;

/// Halves the range by count along the longest axis of the centroids; ties by number.
void halve(const PrimitiveRange& range, PrimitiveRange& left, PrimitiveRange& right,
           const Workers& workers) {
    const int axis = range.widest_axis();
    const std::size_t half = range.size() / 2;
    std::nth_element(range.refs.begin(), range.refs.begin() + static_cast<std::ptrdiff_t>(half),
                     range.refs.end(), [&](const PrimitiveRef& a, const PrimitiveRef& b) {
                         const float ca = a.lower[axis] + a.upper[axis];
                         const float cb = b.lower[axis] + b.upper[axis];
                         return ca < cb || (ca == cb && a.number < b.number);
                     });
    left.refs = range.refs.first(half);
    right.refs = range.refs.subspan(half);
    left.measure(workers);
    right.measure(workers);
}

/// References with room for more behind them.
struct RoomyRange : PrimitiveRange {
    std::size_t room = 0;
    int failures = 0; ///< spatial splits in vain one after the other, down to here
};

/// Shares the room behind two neighbouring ranges by their sizes: a part of the right one moves to
/// its end. Ranges that are not cut any more get none.
void share(std::size_t room, RoomyRange& left, RoomyRange& right) {
    const auto weight = [](const RoomyRange& range) {
        return range.size() > small_range_size ? range.size() : 0;
    };
    const std::size_t sum = weight(left) + weight(right);
    if (room == 0 || sum == 0)
        return;
    left.room = static_cast<std::size_t>(
        static_cast<double>(room) * static_cast<double>(weight(left)) / static_cast<double>(sum));
    right.room = room - left.room;
    PrimitiveRef* const from = right.refs.data();
    PrimitiveRef* const to = from + left.room;
    std::copy_backward(from, from + std::min(left.room, right.size()), to + right.size());
    right.refs = {to, right.size()};
}

class Builder {
  public:
    Builder(const BuildContext& context, const SpatialSplitter& splitter, SplitAxes axes,
            const Workers& workers)
        : context_(context), splitter_(splitter), axes_(axes), workers_(workers) {}

    /// Appends the subtree below a node whose bounds are set.
    void build(const RoomyRange& range, std::size_t node, int depth, TreePiece& piece) const {
        if (range.size() <= small_range_size)
            return build_small_range(context_, range.refs, node, depth, piece);
        RoomyRange half[2];
        split(range, depth, half[0], half[1]);
        share(range.size() + range.room - half[0].size() - half[1].size(), half[0], half[1]);
        const std::uint32_t children = piece.add_pair();
        piece.nodes[node].first = children;
        piece.nodes[children].bounds = half[0].bounds.bounds();
        piece.nodes[children + 1].bounds = half[1].bounds.bounds();
        if (workers_.count() == 1 || range.size() < branch_size) {
            build(half[0], children, depth + 1, piece);
            build(half[1], children + 1, depth + 1, piece);
            return;
        }
        piece.branches.push_back(
            {children + 1, std::make_unique<TreePiece>(half[1].bounds.bounds(), half[1].size())});
        TreePiece& other = *piece.branches.back().piece;
        workers_.invoke([&] { build(half[0], children, depth + 1, piece); },
                        [&] { build(half[1], 0, depth + 1, other); });
    }

  private:
    void split(const RoomyRange& range, int depth, RoomyRange& left, RoomyRange& right) const {
        if (must_halve(range.size(), depth))
            return halve(range, left, right, workers_);
        const auto best = best_binned_split(range, axes_, context_.area_scale, workers_);
        left.failures = right.failures = range.failures;
        if (range.room > 0 && range.failures < max_failures &&
            (!best || is_worth_cutting(range, *best))) {
            const auto spatial = splitter_.best(range, range.room, best ? best->cost : infinity);
            if (spatial && splitter_.apply(range, *spatial, left, right)) {
                left.failures = right.failures = 0;
                return;
            }
            left.failures = right.failures = range.failures + 1;
        }
        if (best)
            return partition(range, *best, left, right, workers_);
        halve(range, left, right, workers_);
    }

    /// Whether the two sides of the best binned split overlap so much that a cut may be better.
    [[nodiscard]] bool is_worth_cutting(const PrimitiveRange& range,
                                        const BinnedSplit& split) const {
        const Box shared{float4::max(split.left.lower, split.right.lower),
                         float4::min(split.left.upper, split.right.upper)};
        if (shared.is_empty())
            return false;
        const float area = shared.half_area(context_.area_scale); // the root has about 1
        return area > least_overlap &&
               area > least_shared_part * range.bounds.half_area(context_.area_scale);
    }

    const BuildContext& context_;
    const SpatialSplitter& splitter_;
    SplitAxes axes_;
    const Workers& workers_;
};

/// 1 / extent of the scene: areas are then about 1 at the root, whatever its size.
Float4 area_scale(const Box& bounds) {
    const float extent = max_component(bounds.bounds().extent());
    return float4::broadcast(extent > 0 && 1 / extent < infinity ? 1 / extent : 1);
}

/// Whether cuts can be computed: at this size products of extents neither overflow nor vanish.
bool is_ordinary(const Box& bounds) {
    const float extent = max_component(bounds.bounds().extent());
    return extent > 1e-15f && extent < 1e15f;
}

} // namespace

BinaryBvh build_binary(const GeometryView& geometry, const BinaryBuildOptions& options) {
    const std::size_t total = geometry.primitive_count();
    if (total > std::size_t{1} << 31)
        throw std::runtime_error("sah: more than 2^31 primitives");
    const Workers workers(total < branch_size ? 1 : options.threads);
    const PrimitiveNumbers numbers(geometry);
    const std::size_t room =
        options.quality == BuildQuality::high
            ? static_cast<std::size_t>(static_cast<double>(total) *
                                       static_cast<double>(options.duplication))
            : 0;
    const PrimitiveRefs refs = make_primitive_refs(geometry, numbers, total + room, workers);
    const std::size_t count = refs.all.size();
    BinaryBvh tree;
    if (count > 0) {
        const BuildContext context{area_scale(refs.all.bounds), numbers.first_sphere(),
                                   traversal_cost_of(count)};
        const SpatialSplitter splitter(geometry, numbers, context.area_scale, workers);
        TreePiece root(refs.all.bounds.bounds(), count);
        const RoomyRange all{refs.all, is_ordinary(refs.all.bounds) ? room : 0};
        const SplitAxes axes =
            options.quality == BuildQuality::fast ? SplitAxes::widest : SplitAxes::all;
        Builder(context, splitter, axes, workers).build(all, 0, 0, root);
        tree = assemble(root, workers);
        if (options.quality == BuildQuality::high)
            optimize_by_reinsertion(tree, {}, context.first_sphere, workers);
    }
    tree.primitive_count = count;
    tree.skipped_count = total - count;
    return tree;
}

} // namespace plumb
