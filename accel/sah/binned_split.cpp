#include "accel/sah/binned_split.h"

#include "accel/sah/partition.h"

#include <algorithm>

namespace plumb {
namespace {

/// Ranges above this size are binned in chunks of it.
constexpr std::size_t chunk_size = 1 << 15;

/// The bins of `axis_count` axes, from `first_axis` on.
template <std::size_t axis_count> struct Bins {
    Box bounds[axis_count][bin_count];
    std::uint32_t count[axis_count][bin_count]{};
    int first_axis = 0;

    explicit Bins(int first) : first_axis(first) {}

    void add(const PrimitiveRef& ref, const BinClassifier& classifier) {
        const Float4 last = float4::broadcast(bin_count - 1);
        const Box box = ref.box();
        std::int32_t bin[4];
        float4::truncate(float4::min(classifier.position(centroid(box)), last), bin);
        for (std::size_t axis = 0; axis < axis_count; ++axis) {
            const std::int32_t b =
                bin[axis_count == 3 ? axis : static_cast<std::size_t>(first_axis)];
            bounds[axis][b].extend(box);
            ++count[axis][b];
        }
    }
    void add(std::span<const PrimitiveRef> refs, const BinClassifier& classifier) {
        std::size_t i = 0;
        if (refs.size() > 512) {
            Bins second(first_axis);
            for (; i + 1 < refs.size(); i += 2) {
                add(refs[i], classifier);
                second.add(refs[i + 1], classifier);
            }
            add(second);
        }
        for (; i < refs.size(); ++i)
            add(refs[i], classifier);
    }
    void add(const Bins& other) {
        for (std::size_t axis = 0; axis < axis_count; ++axis)
            for (int i = 0; i < bin_count; ++i) {
                bounds[axis][i].extend(other.bounds[axis][i]);
                count[axis][i] += other.count[axis][i];
            }
    }
    [[nodiscard]] Box merged(std::size_t axis, int begin, int end) const {
        Box box;
        for (int i = begin; i < end; ++i)
            box.extend(bounds[axis][i]);
        return box;
    }
};

float block_leaf_cost(std::uint32_t count) {
    const std::uint32_t blocks = (count + 7) / 8;
    return static_cast<float>(block_cost) * static_cast<float>(blocks) +
           static_cast<float>(primitive_cost) * static_cast<float>(count);
}

struct Plane {
    std::size_t axis = 0; ///< of those that have bins
    int first_right_bin = 0;
    std::uint32_t left_count = 0;
    float cost = infinity;
};

/// Costs of everything right of each plane are swept from the right, then met from the left.
template <std::size_t axis_count>
void sweep_axis(const Bins<axis_count>& bins, std::size_t axis, std::uint32_t total, Float4 scale,
                Plane& best) {
    float right_cost[bin_count];
    Box box;
    std::uint32_t count = 0;
    for (int i = bin_count - 1; i > 0; --i) {
        box.extend(bins.bounds[axis][i]);
        count += bins.count[axis][i];
        right_cost[i] = count == 0 ? infinity : box.half_area(scale) * block_leaf_cost(count);
    }
    box = {};
    count = 0;
    for (int i = 1; i < bin_count; ++i) {
        box.extend(bins.bounds[axis][i - 1]);
        count += bins.count[axis][i - 1];
        if (count == 0 || count == total)
            continue;
        const float cost = box.half_area(scale) * block_leaf_cost(count) + right_cost[i];
        if (cost < best.cost)
            best = {axis, i, count, cost};
    }
}

template <std::size_t axis_count>
void bin(const PrimitiveRange& range, const BinClassifier& classifier, const Workers& workers,
         Bins<axis_count>& bins) {
    const std::size_t chunks = (range.size() + chunk_size - 1) / chunk_size;
    if (workers.count() == 1 || chunks < 4) {
        bins.add(range.refs, classifier);
        return;
    }
    std::vector<Bins<axis_count>> parts(chunks, Bins<axis_count>(bins.first_axis));
    workers.for_each(chunks, [&](std::size_t i) {
        const std::size_t begin = i * chunk_size;
        parts[i].add(range.refs.subspan(begin, std::min(chunk_size, range.size() - begin)),
                     classifier);
    });
    for (const Bins<axis_count>& part : parts)
        bins.add(part);
}

template <std::size_t axis_count>
std::optional<BinnedSplit> best_split(const PrimitiveRange& range, int first_axis, Float4 scale,
                                      const Workers& workers) {
    const BinClassifier classifier(range.centroids);
    Bins<axis_count> bins(first_axis);
    bin(range, classifier, workers, bins);
    Plane best;
    for (std::size_t axis = 0; axis < axis_count; ++axis)
        sweep_axis(bins, axis, static_cast<std::uint32_t>(range.size()), scale, best);
    if (best.first_right_bin == 0)
        return {};
    return BinnedSplit{classifier,
                       first_axis + static_cast<int>(best.axis),
                       best.first_right_bin,
                       best.left_count,
                       bins.merged(best.axis, 0, best.first_right_bin),
                       bins.merged(best.axis, best.first_right_bin, bin_count),
                       best.cost};
}

} // namespace

BinClassifier::BinClassifier(const Box& centroids) : origin_(centroids.lower) {
    const Bounds b = centroids.bounds();
    const auto scale = [](float lower, float upper) {
        const float s = static_cast<float>(bin_count) / (upper - lower);
        return s < infinity ? s : 0;
    };
    scale_ = float4::set(scale(b.lower.x, b.upper.x), scale(b.lower.y, b.upper.y),
                         scale(b.lower.z, b.upper.z));
}

std::optional<BinnedSplit> best_binned_split(const PrimitiveRange& range, SplitAxes axes,
                                             Float4 scale, const Workers& workers) {
    if (axes == SplitAxes::widest)
        if (const auto split = best_split<1>(range, range.widest_axis(), scale, workers))
            return split;
    return best_split<3>(range, 0, scale, workers);
}

void partition(const PrimitiveRange& range, const BinnedSplit& split, PrimitiveRange& left,
               PrimitiveRange& right, const Workers& workers) {
    left.bounds = split.left;
    right.bounds = split.right;
    partition(
        range.refs, split.left_count,
        [&split](const PrimitiveRef&, Float4 centroid) { return split.goes_left(centroid); }, left,
        right, workers);
}

} // namespace plumb
