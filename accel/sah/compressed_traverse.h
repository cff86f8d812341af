/// \file  Closest-hit and any-hit traversal of the compressed tree, single source for host and
/// device.
///
/// Ylitie, Karras, Laine 2017, algorithm 1: children are met in the order of their slots, turned by
/// the signs of the ray's direction; what is still to be done of one node is a word of bits. The
/// hit is the same for any order (see sah_traverse.h).
///
/// A plane's distance is q A + B with A = step inv and B = (origin - ray origin) inv, a multiply
/// and an add for each of 48 planes. With u = 2^-24 it errs by at most 3u |B| + 2u |q A| from the
/// exact distance, slab_interval of the original box by 2u of that, and 35u on its padded far side.
/// Near planes are moved nearer by 8u (|B| + 256 |A|) and far ones farther by 48u of the same, so
/// no box is passed over that slab_interval enters. Rays and scenes of extreme size, and rays
/// parallel to an axis, take slab_interval itself.
#pragma once

#include "accel/math/bits.h"
#include "accel/sah/compressed_view.h"
#include "accel/sah/sah_traverse.h"

namespace plumb {
namespace detail {

/// a * b + c, rounded once or twice: for boxes only.
RT_HD inline float about_fused(float a, float b, float c) {
#ifdef __CUDA_ARCH__
    return __fmaf_rn(a, b, c);
#else
    return a * b + c;
#endif
}

/// The larger and the smaller of two numbers, neither of which is a NaN: one instruction on a
/// device, where a ? : is two.
RT_HD inline float larger(float a, float b) {
#ifdef __CUDA_ARCH__
    return fmaxf(a, b);
#else
    return max(a, b);
#endif
}
RT_HD inline float smaller(float a, float b) {
#ifdef __CUDA_ARCH__
    return fminf(a, b);
#else
    return min(a, b);
#endif
}

/// What is left to visit of the children of a node: bits 24 to 31, bit 24 + (slot ^ turn); the
/// highest comes first. Bits 0 to 7: which slots hold nodes.
struct NodeGroup {
    std::uint32_t first, bits;

    static constexpr std::uint32_t todo = 0xff000000u;
};

/// Whether the distances q A + B neither overflow nor are undefined.
RT_HD inline bool is_plain(const Ray& ray, float reach) {
    constexpr float large = 0x1p40f, small = 0x1p-40f;
    const Vec3 o = abs(ray.origin), d = abs(ray.direction);
    return reach <= large && max_component(o) <= large && max_component(d) <= large &&
           d.x >= small && d.y >= small && d.z >= small;
}

/// Tests the boxes of a node.
class CompressedTest {
  public:
    RT_HD CompressedTest(const PreparedRay& ray, bool plain)
        : slab_(ray.slab), tmin_(ray.tmin), tmax_(ray.tmax), plain_(plain),
          turn_(7u ^ ((ray.slab.negative[0] ? 1u : 0u) | (ray.slab.negative[1] ? 2u : 0u) |
                      (ray.slab.negative[2] ? 4u : 0u))) {}

    RT_HD void limit(float tmax) { tmax_ = tmax; }
    [[nodiscard]] RT_HD std::uint32_t turn() const { return turn_; }

    /// Bits 0 to 23: primitives of the leaves that are entered; 24 to 31: as in NodeGroup.
    [[nodiscard]] RT_HD std::uint32_t operator()(const CompressedNode& node) const {
        return plain_ ? plain(node) : careful(node);
    }

  private:
    /// The bits of four slots: which they set where they are entered, and where.
    struct Marks {
        std::uint32_t ones, place; ///< a byte a slot

        RT_HD Marks(std::uint32_t meta, std::uint32_t turn) {
            const std::uint32_t inner = (meta & (meta << 1)) & 0x10101010u; // place >= 24
            const std::uint32_t whole = (inner >> 4) * 0xffu;
            ones = (meta >> 5) & 0x07070707u;
            place = (meta ^ (whole & (turn * 0x01010101u))) & 0x1f1f1f1fu;
        }
        [[nodiscard]] RT_HD std::uint32_t bits(std::uint32_t i) const {
            return ((ones >> (8 * i)) & 255u) << ((place >> (8 * i)) & 31u);
        }
    };

    [[nodiscard]] RT_HD std::uint32_t plain(const CompressedNode& node) const {
        float a[3], near_b[3], far_b[3];
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<int>(axis);
            const float inverse = slab_.inv_direction[i];
            a[axis] = node.step(axis) * inverse;
            const float b = (node.origin[axis] - slab_.origin[i]) * inverse;
            const float size = std::fabs(b) + 256 * std::fabs(a[axis]);
            near_b[axis] = b - (8 * unit_roundoff * size + 1e-36f); // products may underflow
            far_b[axis] = b + (48 * unit_roundoff * size + 1e-36f);
        }
        std::uint32_t hits = 0;
        for (std::uint32_t half = 0; half < 2; ++half) {
            const Marks marks(node.meta[half], turn_);
            std::uint32_t near_word[3], far_word[3];
            for (int axis = 0; axis < 3; ++axis) {
                const bool negative = slab_.negative[axis];
                near_word[axis] = negative ? node.upper[axis][half] : node.lower[axis][half];
                far_word[axis] = negative ? node.lower[axis][half] : node.upper[axis][half];
            }
            for (std::uint32_t i = 0; i < 4; ++i) {
                float near = tmin_, far = tmax_;
                for (int axis = 0; axis < 3; ++axis) {
                    const auto q = [i](std::uint32_t word) {
                        return static_cast<float>((word >> (8 * i)) & 255u);
                    };
                    near = larger(near, about_fused(q(near_word[axis]), a[axis], near_b[axis]));
                    far = smaller(far, about_fused(q(far_word[axis]), a[axis], far_b[axis]));
                }
                hits |= near <= far ? marks.bits(i) : 0u;
            }
        }
        return hits;
    }

    [[nodiscard]] RT_HD std::uint32_t careful(const CompressedNode& node) const {
        std::uint32_t hits = 0;
        for (std::uint32_t slot = 0; slot < compressed_width; ++slot) {
            const Marks marks(node.meta[slot / 4], turn_);
            if (overlaps(slab_interval(slab_, node.bounds(slot)), tmin_, tmax_))
                hits |= marks.bits(slot % 4);
        }
        return hits;
    }

    SlabRay slab_;
    float tmin_, tmax_;
    bool plain_;
    std::uint32_t turn_;
};

template <TriangleTest Test>
RT_HD inline bool intersect(const PreparedRay& ray, const CompressedPrimitive& p, float tmax,
                            PrimitiveHit& hit) {
    if (p.is_sphere != 0)
        return intersect_sphere(ray, Sphere{p.a, p.b.x}, tmax, hit);
    return intersect_triangle<Test>(ray, p.a, p.b, p.c, tmax, hit);
}

/// Calls visit(hit, primitive) for hits until it returns true, and says whether it did. `best_t`
/// may shrink meanwhile. The ray must be valid.
template <TriangleTest Test, class Visit, class Tally>
RT_HD inline bool visit_hits(const CompressedView& view, const Ray& ray, const float& best_t,
                             Tally& tally, Visit&& visit) {
    const PreparedRay prepared(ray);
    CompressedTest test(prepared, is_plain(ray, view.reach));
    NodeGroup stack[compressed_max_depth];
    int size = 0;
    NodeGroup group{0, 0x80000000u}; // the root: no slot before it holds a node
    for (;;) {
        const std::uint32_t place = highest_one(group.bits);
        const std::uint32_t slot = (place - 24) ^ test.turn();
        const std::uint32_t before = ones(group.bits & 0xffu & ((1u << slot) - 1));
        group.bits &= ~(1u << place);
        const CompressedNode node = view.nodes[group.first + before];
        if ((group.bits & NodeGroup::todo) != 0)
            stack[size++] = group;
        tally.node();
        const std::uint32_t hits = test(node);
        group = {node.first_child, (hits & NodeGroup::todo) | node.inner_mask()};
        for (std::uint32_t left = hits & ~NodeGroup::todo; left != 0; left &= left - 1) {
            const CompressedPrimitive p = view.primitives[node.first_primitive + lowest_one(left)];
            PrimitiveHit hit;
            tally.primitive();
            if (intersect<Test>(prepared, p, best_t, hit) && visit(hit, p))
                return true;
            test.limit(best_t);
        }
        if ((group.bits & NodeGroup::todo) == 0) {
            if (size == 0)
                return false;
            group = stack[--size];
        }
    }
}

} // namespace detail

/// Closest hit of one ray. An invalid ray misses.
template <TriangleTest Test, class Tally = NoTally>
[[nodiscard]] RT_HD inline Hit closest(const CompressedView& view, const Ray& ray,
                                       Tally&& tally = {}) {
    Hit best;
    if (!is_valid(ray))
        return best;
    best.t = ray.tmax;
    detail::visit_hits<Test>(view, ray, best.t, tally,
                             [&best](const PrimitiveHit& hit, const CompressedPrimitive& p) {
                                 detail::keep_closer(hit, p.geometry, p.primitive, best);
                                 return false;
                             });
    if (!best.valid())
        best.t = infinity;
    return best;
}

/// Whether any hit exists; equal to closest(view, ray).valid().
template <TriangleTest Test, class Tally = NoTally>
[[nodiscard]] RT_HD inline bool occluded(const CompressedView& view, const Ray& ray,
                                         Tally&& tally = {}) {
    return is_valid(ray) &&
           detail::visit_hits<Test>(
               view, ray, ray.tmax, tally,
               [](const PrimitiveHit&, const CompressedPrimitive&) { return true; });
}

} // namespace plumb
