/// \file  Which children of a compressed node a ray enters, single source for host and device.
///
/// A plane's distance is q a + b with a = step inv and b = (origin - ray origin) inv. A byte q
/// becomes a number by being put between others: v = 1 + q 2^-15 is one instruction of a device,
/// where converting q takes two or three. So the distance is v A + B with A = 2^15 a and B = b - A,
/// for each of 48 planes. With u = 2^-24, b errs by 3u |b| and q a by 2u |q a|, B by u (|b| + |A|),
/// the product by 1.01u |A| and the sum by u (|b| + |q a|): at most 5u |b| + 2.1u |A| together.
/// slab_interval of the original box errs by 2u of the distance, and 35u on its padded far side.
/// Near planes are moved nearer by 12u |b| + 6u |A|, 1 % of a step of the grid, and far ones
/// farther by 60u |b| + 6u |A|, so no box is passed over that slab_interval enters. Rays and scenes
/// of extreme size, and rays parallel to an axis, take slab_interval itself.
#pragma once

#include "accel/prepared_ray.h"
#include "accel/sah/compressed_view.h"

namespace plumb::detail {

/// a * b + c, rounded once or twice: for boxes only.
RT_HD inline float about_fused(float a, float b, float c) {
#ifdef __CUDA_ARCH__
    return __fmaf_rn(a, b, c);
#else
    return a * b + c;
#endif
}

/// 1 + q 2^-15 for byte i of a word, exactly. `one`: the bits of 1.0f.
RT_HD inline float with_byte(std::uint32_t word, std::uint32_t i, std::uint32_t one) {
#ifdef __CUDA_ARCH__
    return std::bit_cast<float>(__byte_perm(word, one, 0x7604u | i << 4));
#else
    return std::bit_cast<float>(one | ((word >> (8 * i)) & 255u) << 8);
#endif
}

/// The largest of `from` >= 0 and three numbers, and the smallest of `to` >= 0 and three, none of
/// them a NaN. Their bits are compared as integers, of which a device takes three in an
/// instruction: where all is positive that is the order of the numbers, and a negative end of an
/// interval that starts at 0 or later stays negative, or becomes -0, which only visits a box more.
RT_HD inline float largest(float from, float x, float y, float z) {
    const auto bits = [](float a) { return std::bit_cast<std::int32_t>(a); };
    const auto larger = [](std::int32_t a, std::int32_t b) { return a > b ? a : b; };
#ifdef __CUDA_ARCH__
    return std::bit_cast<float>(__vimax3_s32(larger(bits(from), bits(x)), bits(y), bits(z)));
#else
    return std::bit_cast<float>(larger(larger(bits(from), bits(x)), larger(bits(y), bits(z))));
#endif
}
RT_HD inline float smallest(float to, float x, float y, float z) {
    const auto bits = [](float a) { return std::bit_cast<std::int32_t>(a); };
    const auto smaller = [](std::int32_t a, std::int32_t b) { return a < b ? a : b; };
#ifdef __CUDA_ARCH__
    return std::bit_cast<float>(__vimin3_s32(smaller(bits(to), bits(x)), bits(y), bits(z)));
#else
    return std::bit_cast<float>(smaller(smaller(bits(to), bits(x)), smaller(bits(y), bits(z))));
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
    RT_HD CompressedTest(const PreparedRay& ray, bool plain, std::uint32_t one)
        : slab_(ray.slab), tmin_(ray.tmin), tmax_(ray.tmax), plain_(plain), one_(one),
          turn_(7u ^ ((ray.slab.negative[0] ? 1u : 0u) | (ray.slab.negative[1] ? 2u : 0u) |
                      (ray.slab.negative[2] ? 4u : 0u))) {}

    RT_HD void limit(float tmax) { tmax_ = tmax; }
    [[nodiscard]] RT_HD std::uint32_t turn() const { return turn_; }

    /// Bits 0 to 23: primitives of the leaves that are entered; 24 to 31: as in NodeGroup. `node`
    /// and `in_memory` are the same: a loop over the slots of a copy would keep it out of
    /// registers.
    [[nodiscard]] RT_HD std::uint32_t operator()(const CompressedNode& node,
                                                 const CompressedNode& in_memory) const {
        return plain_ ? plain(node) : careful(in_memory);
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
            a[axis] = node.step(axis) * (0x1p15f * inverse);
            const float b = (node.origin[axis] - slab_.origin[i]) * inverse;
            const float moved = b - a[axis];
            const float least = 6 * unit_roundoff * std::fabs(a[axis]) + 1e-36f; // for underflow
            near_b[axis] = moved - (12 * unit_roundoff * std::fabs(b) + least);
            far_b[axis] = moved + (60 * unit_roundoff * std::fabs(b) + least);
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
                float near[3], far[3];
                for (int axis = 0; axis < 3; ++axis) {
                    near[axis] =
                        about_fused(with_byte(near_word[axis], i, one_), a[axis], near_b[axis]);
                    far[axis] =
                        about_fused(with_byte(far_word[axis], i, one_), a[axis], far_b[axis]);
                }
                hits |= largest(tmin_, near[0], near[1], near[2]) <=
                                smallest(tmax_, far[0], far[1], far[2])
                            ? marks.bits(i)
                            : 0u;
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
    std::uint32_t one_, turn_;
};

} // namespace plumb::detail
