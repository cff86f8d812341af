#include "accel/sah/spatial_split.h"

#include "accel/sah/partition.h"

#include <algorithm>

namespace plumb {
namespace {

constexpr std::size_t chunk_size = 1 << 13;

/// Of larger ranges as many references choose the plane. All then decide whether it is worth it.
constexpr std::size_t sample_size = 1024;

float cost_of(float left_area, std::size_t left_count, float right_area, std::size_t right_count) {
    return left_area * static_cast<float>(leaf_cost(left_count)) +
           right_area * static_cast<float>(leaf_cost(right_count));
}

/// leaf_cost without the rounding up to blocks: for the choice of single primitives.
float smooth_cost(std::size_t count) {
    return static_cast<float>(block_cost / 8 + primitive_cost) * static_cast<float>(count);
}

} // namespace

SpatialBins::SpatialBins(const Box& bounds, int count) : origin_(bounds.lower), count_(count) {
    const Bounds b = bounds.bounds();
    float per_bin[3];
    for (int axis = 0; axis < 3; ++axis) {
        lower_[axis] = b.lower[axis];
        width_[axis] = (b.upper[axis] - b.lower[axis]) / static_cast<float>(count);
        per_bin[axis] = 1 / width_[axis];
        if (!(per_bin[axis] < infinity))
            width_[axis] = per_bin[axis] = 0;
    }
    scale_ = float4::set(per_bin[0], per_bin[1], per_bin[2]);
}

BinSpans SpatialBins::spans(const Box& box) const {
    BinSpans spans;
    float4::truncate(position(box.lower), spans.first);
    float4::truncate(position(box.upper), spans.last);
    return spans;
}

BinSpans SpatialBins::whole(const Box& box) const {
    const Float4 middle = float4::multiply(float4::broadcast(0.5f), centroid(box));
    return spans({middle, middle});
}

Float4 SpatialBins::position(Float4 point) const {
    const Float4 x = float4::multiply(float4::subtract(point, origin_), scale_);
    return float4::min(x, float4::broadcast(static_cast<float>(count_ - 1)));
}

struct SpatialSplitter::Counts {
    Box bounds[3][max_spatial_bins];
    std::uint32_t enter[3][max_spatial_bins]{}, leave[3][max_spatial_bins]{};

    void add(const Counts& other) {
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < max_spatial_bins; ++i) {
                bounds[axis][i].extend(other.bounds[axis][i]);
                enter[axis][i] += other.enter[axis][i];
                leave[axis][i] += other.leave[axis][i];
            }
    }
    [[nodiscard]] Box merged(int axis, int begin, int end) const {
        Box box;
        for (int i = begin; i < end; ++i)
            box.extend(bounds[axis][i]);
        return box;
    }
};

/// What becomes of one reference.
struct SpatialSplitter::Cut {
    Side side;
    Box below, above; ///< set where it goes to both
};

std::optional<ClipTriangle> SpatialSplitter::triangle(PrimitiveNumber number) const {
    if (number >= numbers_.first_sphere())
        return {};
    const auto id = numbers_.id(number);
    const ClipTriangle triangle(geometry_.vertices(id.geometry, id.primitive), area_scale_);
    return triangle.can_be_cut() ? std::optional(triangle) : std::nullopt;
}

void SpatialSplitter::bin(std::span<const PrimitiveRef> refs, std::uint32_t stride,
                          const SpatialBins& bins, Counts& counts) const {
    for (std::size_t n = 0; n < refs.size(); n += stride) {
        const PrimitiveRef& ref = refs[n];
        const Box box = ref.box();
        BinSpans spans = bins.spans(box);
        const bool is_whole = spans.first[0] == spans.last[0] && spans.first[1] == spans.last[1] &&
                              spans.first[2] == spans.last[2];
        const auto cuttable = is_whole ? std::nullopt : triangle(ref.number);
        if (!is_whole && !cuttable)
            spans = bins.whole(box);
        for (int axis = 0; axis < 3; ++axis) {
            const int first = spans.first[axis], last = spans.last[axis];
            counts.enter[axis][first] += stride;
            counts.leave[axis][last] += stride;
            Box rest = box;
            for (int i = first; i < last; ++i) {
                const Box uncut = rest;
                Box part;
                cuttable->cut(axis, bins.plane(axis, i + 1), uncut, part, rest);
                counts.bounds[axis][i].extend(part);
            }
            counts.bounds[axis][last].extend(rest);
        }
    }
}

std::optional<SpatialSplit> SpatialSplitter::best(const PrimitiveRange& range, std::size_t room,
                                                  float limit) const {
    const bool is_sample = range.size() >= 2 * sample_size;
    const auto stride = is_sample ? range.size() / sample_size : 1;
    const SpatialBins bins(range.bounds, is_sample ? max_spatial_bins : max_spatial_bins / 4);
    Counts counts;
    bin(range.refs, static_cast<std::uint32_t>(stride), bins, counts);
    Search search{
        is_sample ? range.size() + stride : range.size(), is_sample ? 2 * room : room, limit, {}};
    for (int axis = 0; axis < 3; ++axis)
        sweep(counts, axis, bins, search);
    if (is_sample && search.best) {
        SpatialSplit& split = *search.best;
        measure(range.refs, split);
        if (split.cost >= limit || std::max(split.left_count, split.right_count) >= range.size() ||
            split.left_count + split.right_count > range.size() + room)
            return {};
    }
    return search.best;
}

void SpatialSplitter::measure(std::span<const PrimitiveRef> refs, SpatialSplit& split) const {
    struct Part {
        std::size_t count = 0;
        Box box;
        void add(const Box& other) {
            ++count;
            box.extend(other);
        }
    };
    struct Sides {
        Part left, right;
    };
    std::vector<Sides> chunks((refs.size() + chunk_size - 1) / chunk_size);
    workers_.for_each(chunks.size(), [&](std::size_t i) {
        Sides sides;
        const std::size_t begin = i * chunk_size;
        for (const PrimitiveRef& ref :
             refs.subspan(begin, std::min(chunk_size, refs.size() - begin))) {
            const Cut parts = cut(ref, split);
            if (parts.side != goes_right)
                sides.left.add(parts.side == goes_both ? parts.below : ref.box());
            if (parts.side != goes_left)
                sides.right.add(parts.side == goes_both ? parts.above : ref.box());
        }
        chunks[i] = sides;
    });
    Sides sum;
    for (const Sides& sides : chunks) {
        sum.left.count += sides.left.count;
        sum.right.count += sides.right.count;
        sum.left.box.extend(sides.left.box);
        sum.right.box.extend(sides.right.box);
    }
    const auto area = [&](const Part& part) {
        return part.count == 0 ? 0 : part.box.half_area(area_scale_);
    };
    split.left_count = sum.left.count;
    split.right_count = sum.right.count;
    split.left = sum.left.box;
    split.right = sum.right.box;
    split.left_area = area(sum.left);
    split.right_area = area(sum.right);
    split.cost = cost_of(split.left_area, split.left_count, split.right_area, split.right_count);
}

void SpatialSplitter::sweep(const Counts& counts, int axis, const SpatialBins& bins,
                            Search& search) const {
    if (!bins.usable(axis))
        return;
    Box right[max_spatial_bins];
    std::size_t right_count[max_spatial_bins];
    Box box;
    std::size_t sum = 0;
    for (int i = bins.count() - 1; i > 0; --i) {
        box.extend(counts.bounds[axis][i]);
        right[i] = box;
        right_count[i] = sum += counts.leave[axis][i];
    }
    box = {};
    sum = 0;
    for (int i = 1; i < bins.count(); ++i) {
        box.extend(counts.bounds[axis][i - 1]);
        sum += counts.enter[axis][i - 1];
        if (sum == 0 || right_count[i] == 0 || sum >= search.count ||
            right_count[i] >= search.count || sum + right_count[i] > search.count + search.room)
            continue;
        const float left_area = box.half_area(area_scale_);
        const float right_area = right[i].half_area(area_scale_);
        const float cost = cost_of(left_area, sum, right_area, right_count[i]);
        if (cost < search.limit) {
            search.limit = cost;
            search.best = SpatialSplit{bins, axis,     i,         sum,        right_count[i],
                                       box,  right[i], left_area, right_area, cost};
        }
    }
}

SpatialSplitter::Cut SpatialSplitter::cut(const PrimitiveRef& ref,
                                          const SpatialSplit& split) const {
    const auto side_of = [&](const BinSpans& spans) {
        return spans.last[split.axis] < split.first_right_bin     ? goes_left
               : spans.first[split.axis] >= split.first_right_bin ? goes_right
                                                                  : goes_both;
    };
    const Box whole = ref.box();
    Cut cut{};
    cut.side = side_of(split.bins.spans(whole));
    if (cut.side != goes_both)
        return cut;
    const auto cuttable = triangle(ref.number);
    if (!cuttable) {
        cut.side = side_of(split.bins.whole(whole));
        return cut;
    }
    cuttable->cut(split.axis, split.bins.plane(split.axis, split.first_right_bin), whole, cut.below,
                  cut.above);
    if (cut.below.is_empty() || cut.above.is_empty()) {
        cut.side = cut.below.is_empty() ? goes_right : goes_left;
        return cut;
    }
    return cut;
}

SpatialSplitter::Side SpatialSplitter::cheapest_side(const Box& whole,
                                                     const SpatialSplit& split) const {
    const auto area_with = [&](const Box& side) {
        Box box = side;
        box.extend(whole);
        return box.half_area(area_scale_);
    };
    const float left = smooth_cost(split.left_count), right = smooth_cost(split.right_count);
    const float one = smooth_cost(1);
    const float both = split.left_area * left + split.right_area * right;
    const float only_left = area_with(split.left) * left + split.right_area * (right - one);
    const float only_right = split.left_area * (left - one) + area_with(split.right) * right;
    if (std::min(only_left, only_right) >= both)
        return goes_both;
    return only_left <= only_right ? goes_left : goes_right;
}

bool SpatialSplitter::apply(const PrimitiveRange& range, const SpatialSplit& split,
                            PrimitiveRange& left, PrimitiveRange& right) const {
    struct Sides {
        std::size_t count[3]{};
    };
    const std::span<PrimitiveRef> refs = range.refs;
    const std::size_t chunks = (refs.size() + chunk_size - 1) / chunk_size;
    std::vector<Sides> sides(chunks);
    const auto for_chunk = [&](std::size_t chunk, auto&& visit) {
        const std::size_t begin = chunk * chunk_size;
        for (PrimitiveRef& ref : refs.subspan(begin, std::min(chunk_size, refs.size() - begin)))
            visit(ref);
    };
    workers_.for_each(chunks, [&](std::size_t i) {
        for_chunk(i, [&](PrimitiveRef& ref) {
            ref.side = cut(ref, split).side;
            if (ref.side == goes_both)
                ref.side = cheapest_side(ref.box(), split);
            ++sides[i].count[ref.side];
        });
    });
    Sides total;
    for (Sides& s : sides) {
        const std::size_t before = total.count[goes_both];
        for (int side = 0; side < 3; ++side)
            total.count[side] += s.count[side];
        s.count[goes_both] = before; // where the chunk's new references begin
    }
    const std::size_t left_count = total.count[goes_left] + total.count[goes_both];
    const std::size_t right_count = total.count[goes_right] + total.count[goes_both];
    if (left_count == 0 || right_count == 0)
        return false;
    PrimitiveRef* const behind = refs.data() + refs.size();
    workers_.for_each(chunks, [&](std::size_t i) {
        PrimitiveRef* next = behind + sides[i].count[goes_both];
        for_chunk(i, [&](PrimitiveRef& ref) {
            if (ref.side != goes_both)
                return;
            const Cut parts = cut(ref, split);
            ref.set(parts.below, ref.number);
            ref.side = goes_left;
            next->set(parts.above, ref.number);
            next++->side = goes_right;
        });
    });
    partition(
        {refs.data(), left_count + right_count}, left_count,
        [](const PrimitiveRef& ref, Float4) { return 1 - ref.side; }, left, right, workers_);
    left.measure(workers_);
    right.measure(workers_);
    return true;
}

} // namespace plumb
