/// \file  The compressed 8-wide tree as kernels see it: plain arrays, host and device.
///
/// H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed
/// Wide BVHs", HPG 2017. A node of 80 bytes holds the boxes of up to eight children in 8-bit steps
/// of a grid of its own, rounded outwards. What is hit is decided by the primitives' own test, in
/// full precision: the boxes change no bit of it.
#pragma once

#include "accel/geometry.h"

#include <bit>
#include <type_traits>

namespace plumb {

inline constexpr std::uint32_t compressed_width = 8;
inline constexpr std::uint32_t compressed_max_leaf = 3; ///< primitives
/// Of the deepest node, the root being 0. A traversal keeps at most one group of nodes a level.
inline constexpr int compressed_max_depth = 72;

/// A child sits in one of eight slots: bit a of its slot is set where it lies towards the upper end
/// of axis a. Bytes are numbered from the lowest.
struct alignas(16) CompressedNode {
    float origin[3];               ///< of the grid: lower corner of the node's box
    std::uint32_t exponents;       ///< bytes 0 to 2: step of the grid, 2^(byte - 127) on each axis;
                                   ///< byte 3: which slots hold nodes
    std::uint32_t first_child;     ///< nodes of its slots, in the order of slots
    std::uint32_t first_primitive; ///< primitives of its leaves, likewise
    /// A byte a slot. 0: empty. Node: 001 above 24 + slot. Leaf: as many ones as it has primitives,
    /// in the upper three bits, above the number of primitives in slots before it.
    std::uint32_t meta[2];
    std::uint32_t lower[3][2], upper[3][2]; ///< [axis]: a byte a slot

    [[nodiscard]] RT_HD static std::uint32_t byte(const std::uint32_t (&words)[2],
                                                  std::uint32_t slot) {
        return (words[slot / 4] >> (8 * (slot % 4))) & 255u;
    }
    [[nodiscard]] RT_HD std::uint32_t inner_mask() const { return exponents >> 24; }
    [[nodiscard]] RT_HD float step(std::uint32_t axis) const {
        return std::bit_cast<float>(((exponents >> (8 * axis)) & 255u) << 23);
    }
    /// The box of a slot that is not empty.
    [[nodiscard]] RT_HD Bounds bounds(std::uint32_t slot) const {
        Bounds box;
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            const float p = origin[axis], s = step(axis);
            const auto a = static_cast<int>(axis);
            box.lower[a] = p + static_cast<float>(byte(lower[axis], slot)) * s; // exact product
            box.upper[a] = p + static_cast<float>(byte(upper[axis], slot)) * s;
        }
        return box;
    }
};
static_assert(sizeof(CompressedNode) == 80);

/// A triangle (a, b, c), or a sphere around `a` with the radius b.x.
struct alignas(16) CompressedPrimitive {
    Vec3 a;
    std::uint32_t geometry;
    Vec3 b;
    std::uint32_t primitive;
    Vec3 c;
    std::uint32_t is_sphere;
};
static_assert(sizeof(CompressedPrimitive) == 48);

/// nodes[0] is the root; in an empty tree its slots are empty.
struct CompressedView {
    const CompressedNode* nodes = nullptr;
    const CompressedPrimitive* primitives = nullptr;
    std::uint32_t node_count = 0, primitive_count = 0;
    float reach = 0; ///< largest absolute coordinate of the root's box
    /// The bits of 1.0f. A compiler that knew them would put them into the instruction that places
    /// a byte among them, and the place of the byte into a register before each.
    std::uint32_t one = 0x3f800000u;
};
static_assert(std::is_trivially_copyable_v<CompressedView>);

} // namespace plumb
