#include "accel/sah/binned_split.h"

#include "accel/sah/partition.h"

#include <algorithm>

namespace plumb {
namespace {

/// Ranges above this size are binned in chunks of it.
constexpr std::size_t chunk_size = 1 << 15;

struct Bins {
    Box bounds[3][bin_count];
    std::uint32_t count[3][bin_count]{};

    void add(const PrimitiveRef& ref, const BinClassifier& classifier) {
        const Float4 last = float4::broadcast(bin_count - 1);
        const Box box = ref.box();
        std::int32_t bin[4];
        float4::truncate(float4::min(classifier.position(centroid(box)), last), bin);
        for (int axis = 0; axis < 3; ++axis) {
            bounds[axis][bin[axis]].extend(box);
            ++count[axis][bin[axis]];
        }
    }
    void add(std::span<const PrimitiveRef> refs, const BinClassifier& classifier) {
        std::size_t i = 0;
        if (refs.size() > 512) {
            Bins second;
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
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < bin_count; ++i) {
                bounds[axis][i].extend(other.bounds[axis][i]);
                count[axis][i] += other.count[axis][i];
            }
    }
    [[nodiscard]] Box merged(int axis, int begin, int end) const {
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
    int axis = 0, first_right_bin = 0;
    std::uint32_t left_count = 0;
    float cost = infinity;
};

/// Costs of everything right of each plane are swept from the right, then met from the left.
void sweep_axis(const Bins& bins, int axis, std::uint32_t total, Float4 scale, Plane& best) {
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

void bin(const PrimitiveRange& range, const BinClassifier& classifier, const Workers& workers,
         Bins& bins) {
    const std::size_t chunks = (range.size() + chunk_size - 1) / chunk_size;
    if (workers.count() == 1 || chunks < 4) {
        bins.add(range.refs, classifier);
        return;
    }
    std::vector<Bins> parts(chunks);
    workers.for_each(chunks, [&](std::size_t i) {
        const std::size_t begin = i * chunk_size;
        parts[i].add(range.refs.subspan(begin, std::min(chunk_size, range.size() - begin)),
                     classifier);
    });
    for (const Bins& part : parts)
        bins.add(part);
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

std::optional<BinnedSplit> best_binned_split(const PrimitiveRange& range, Float4 scale,
                                             const Workers& workers) {
    const BinClassifier classifier(range.centroids);
    Bins bins;
    bin(range, classifier, workers, bins);
    Plane best;
    for (int axis = 0; axis < 3; ++axis)
        sweep_axis(bins, axis, static_cast<std::uint32_t>(range.size()), scale, best);
    if (best.first_right_bin == 0)
        return {};
    return BinnedSplit{classifier,
                       best.axis,
                       best.first_right_bin,
                       best.left_count,
                       bins.merged(best.axis, 0, best.first_right_bin),
                       bins.merged(best.axis, best.first_right_bin, bin_count),
                       best.cost};
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
