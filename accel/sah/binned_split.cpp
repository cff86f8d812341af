#include "accel/sah/binned_split.h"

#include <algorithm>
#include <array>

namespace plumb {
namespace {

struct Bin {
    Bounds bounds;
    std::uint32_t count = 0;
};

using Bins = std::array<Bin, bin_count>;

struct Candidate {
    int first_right_bin = 0;
    double cost = std::numeric_limits<double>::infinity();
};

/// Costs of everything left of each plane are swept from the left, then met from the right.
Candidate best_plane(const Bins& bins) {
    std::array<double, bin_count> left_cost{};
    std::array<std::uint32_t, bin_count> left_count{};
    Bounds bounds;
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < bin_count; ++i) {
        left_count[i] = count;
        left_cost[i] = surface_area(bounds) * leaf_cost(count);
        bounds.extend(bins[i].bounds);
        count += bins[i].count;
    }
    bounds = {};
    count = 0;
    Candidate best;
    for (std::size_t i = bin_count - 1; i > 0; --i) {
        if (bins[i].count == 0)
            continue;
        bounds.extend(bins[i].bounds);
        count += bins[i].count;
        const double cost = left_cost[i] + surface_area(bounds) * leaf_cost(count);
        if (left_count[i] != 0 && cost < best.cost)
            best = {static_cast<int>(i), cost};
    }
    return best;
}

} // namespace

PrimitiveRange::PrimitiveRange(std::span<PrimitiveRef> primitives) : refs(primitives) {
    for (const PrimitiveRef& ref : refs) {
        bounds.extend(ref.bounds);
        centroids.extend(ref.centroid());
    }
}

BinClassifier::BinClassifier(int axis, const Bounds& centroids)
    : axis_(axis), origin_(centroids.lower[axis]),
      scale_(static_cast<float>(bin_count) / (centroids.upper[axis] - centroids.lower[axis])) {}

bool BinClassifier::usable() const { return scale_ < infinity; }

int BinClassifier::operator()(const PrimitiveRef& ref) const {
    const float position = component(ref.bounds.lower, axis_) + component(ref.bounds.upper, axis_);
    return std::min(static_cast<int>((position - origin_) * scale_), bin_count - 1);
}

double leaf_cost(std::size_t count) {
    const std::size_t blocks = (count + 7) / 8;
    return block_cost * static_cast<double>(blocks) + primitive_cost * static_cast<double>(count);
}

std::optional<BinnedSplit> best_binned_split(const PrimitiveRange& range) {
    const BinClassifier classify[3]{
        {0, range.centroids}, {1, range.centroids}, {2, range.centroids}};
    std::array<Bins, 3> bins;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!classify[axis].usable())
            continue;
        for (const PrimitiveRef& ref : range.refs) {
            Bin& bin = bins[axis][static_cast<std::size_t>(classify[axis](ref))];
            bin.bounds.extend(ref.bounds);
            ++bin.count;
        }
    }
    std::optional<BinnedSplit> best;
    const double node = traversal_cost * surface_area(range.bounds);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!classify[axis].usable())
            continue;
        const Candidate candidate = best_plane(bins[axis]);
        if (candidate.first_right_bin != 0 && (!best || node + candidate.cost < best->cost))
            best = {classify[axis], candidate.first_right_bin, node + candidate.cost};
    }
    return best;
}

} // namespace plumb
