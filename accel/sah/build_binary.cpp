#include "accel/sah/build_binary.h"

#include "accel/sah/binned_split.h"
#include "accel/sah/small_range.h"

#include <algorithm>
#include <stdexcept>

namespace plumb {
namespace {

/// Below nodes of at least this size the right subtree is a piece of its own where there are
/// threads to build it. The tree does not depend on it.
constexpr std::size_t branch_size = 4096;

/// Halves the range by count along the longest axis of the centroids; ties by number.
void halve(const PrimitiveRange& range, PrimitiveRange& left, PrimitiveRange& right) {
    const Vec3 extent = range.centroids.bounds().extent();
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    const std::size_t half = range.size() / 2;
    std::nth_element(range.refs.begin(), range.refs.begin() + static_cast<std::ptrdiff_t>(half),
                     range.refs.end(), [&](const PrimitiveRef& a, const PrimitiveRef& b) {
                         const float ca = a.lower[axis] + a.upper[axis];
                         const float cb = b.lower[axis] + b.upper[axis];
                         return ca < cb || (ca == cb && a.number < b.number);
                     });
    left.refs = range.refs.first(half);
    right.refs = range.refs.subspan(half);
    left.measure();
    right.measure();
}

class Builder {
  public:
    Builder(const BuildContext& context, const Workers& workers)
        : context_(context), workers_(workers) {}

    /// Appends the subtree below a node whose bounds are set.
    void build(const PrimitiveRange& range, std::size_t node, int depth, TreePiece& piece) const {
        if (range.size() <= small_range_size)
            return build_small_range(context_, range.refs, node, depth, piece);
        PrimitiveRange half[2];
        split(range, depth, half[0], half[1]);
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
    void split(const PrimitiveRange& range, int depth, PrimitiveRange& left,
               PrimitiveRange& right) const {
        if (!must_halve(range.size(), depth))
            if (const auto best = best_binned_split(range, context_.area_scale, workers_))
                return partition(range, *best, left, right, workers_);
        halve(range, left, right);
    }

    const BuildContext& context_;
    const Workers& workers_;
};

/// 1 / extent of the scene: areas are then about 1 at the root, whatever its size.
Float4 area_scale(const Box& bounds) {
    const float extent = max_component(bounds.bounds().extent());
    return float4::broadcast(extent > 0 && 1 / extent < infinity ? 1 / extent : 1);
}

} // namespace

BinaryBvh build_binary(const GeometryView& geometry, const BinaryBuildOptions& options) {
    const std::size_t total = geometry.primitive_count();
    if (total > std::size_t{1} << 31)
        throw std::runtime_error("sah: more than 2^31 primitives");
    const Workers workers(total < branch_size ? 1 : options.threads);
    const PrimitiveNumbers numbers(geometry);
    const PrimitiveRefs refs = make_primitive_refs(geometry, numbers, total, workers);
    const std::size_t count = refs.all.size();
    BinaryBvh tree;
    if (count > 0) {
        const BuildContext context{area_scale(refs.all.bounds), numbers.first_sphere()};
        TreePiece root(refs.all.bounds.bounds(), count);
        Builder(context, workers).build(refs.all, 0, 0, root);
        tree = assemble(root, workers);
    }
    tree.primitive_count = count;
    tree.skipped_count = total - count;
    return tree;
}

} // namespace plumb
