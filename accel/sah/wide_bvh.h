/// \file  The 8-wide tree that the CPU traverses: nodes and leaf blocks in one arena.
#pragma once

#include "accel/sah/binary_bvh.h"
#include "accel/sah/tree_memory.h"

#include <cstddef>
#include <vector>

namespace plumb {

inline constexpr int wide_width = 8;      ///< children of a node, triangles or spheres of a block
inline constexpr int wide_max_depth = 64; ///< of a leaf, the root being 0
/// A depth-first traversal holds at most seven other children a level, and one node's all.
inline constexpr int wide_max_stack = (wide_width - 1) * wide_max_depth + wide_width;

/// A child: an inner node, a block of triangles or a block of spheres, and where it lies in the
/// arena, in units of a cache line.
struct WideRef {
    std::uint32_t bits = 0;

    static constexpr std::uint32_t leaf_flag = 0x80000000u, sphere_flag = 0x40000000u;
    static constexpr std::uint32_t max_unit = sphere_flag - 1;

    [[nodiscard]] constexpr bool is_leaf() const { return (bits & leaf_flag) != 0; }
    [[nodiscard]] constexpr bool has_spheres() const { return (bits & sphere_flag) != 0; }
    [[nodiscard]] constexpr std::size_t unit() const { return bits & max_unit; }
};

/// Boxes of up to eight children, transposed. A child that is not there has an empty box (lower
/// +inf, upper -inf) and stands behind those that are.
struct alignas(64) WideNode {
    float planes[3][2][wide_width]; ///< [axis][lower, upper][child]
    WideRef child[wide_width];
    std::uint32_t rest[8]{}; ///< zeros, or the same tree would not be the same bytes

    [[nodiscard]] Bounds bounds(int i) const {
        return {{planes[0][0][i], planes[1][0][i], planes[2][0][i]},
                {planes[0][1][i], planes[1][1][i], planes[2][1][i]}};
    }
};
static_assert(sizeof(WideNode) == 256);

/// Up to eight triangles, transposed, in ascending order of their numbers. Lanes without a triangle
/// repeat the last one: they can only find what it finds.
struct alignas(64) WideTriangles {
    float vertex[3][3][wide_width]; ///< [a, b, c][axis][lane]
    PrimitiveNumber number[wide_width];

    [[nodiscard]] Vec3 corner(int i, int lane) const {
        return {vertex[i][0][lane], vertex[i][1][lane], vertex[i][2][lane]};
    }
};
static_assert(sizeof(WideTriangles) == 320);

/// Up to eight spheres, likewise.
struct alignas(64) WideSpheres {
    Sphere sphere[wide_width];
    PrimitiveNumber number[wide_width];
    std::uint32_t rest[8]{}; ///< as in WideNode
};
static_assert(sizeof(WideSpheres) == 192);

/// What a traversal reads. Valid as long as its WideBvh.
struct WideView {
    const std::byte* memory = nullptr; ///< the root, an inner node, lies first
    /// First number of each geometry, then first_of_padding times one that no primitive has.
    const PrimitiveNumber* first_of = nullptr;
    std::uint32_t geometry_count = 0; ///< meshes and the one of all spheres
    float reach = 0;                  ///< largest absolute coordinate of the root's box
    bool empty = true;                ///< nothing to hit, no root
    bool one_level = false;           ///< the root's children are all blocks of triangles
    bool tiny = false;                ///< fits in the first-level cache beside the rest

    static constexpr std::size_t unit_bytes = 64;

    template <class T> [[nodiscard]] const T& at(WideRef ref) const {
        return *reinterpret_cast<const T*>(memory + ref.unit() * unit_bytes);
    }
    /// The eight primitives of a leaf, ascending; the last fills up the rest.
    [[nodiscard]] const PrimitiveNumber* numbers(WideRef leaf) const {
        return leaf.has_spheres() ? at<WideSpheres>(leaf).number : at<WideTriangles>(leaf).number;
    }
};

/// So many numbers behind WideView::first_of may be read with the last of them.
inline constexpr std::size_t first_of_padding = 8;

struct WideBvh {
    TreeMemory memory;                     ///< the root, an inner node, lies first
    std::vector<PrimitiveNumber> first_of; ///< padded, as WideView::first_of
    float reach = 0;
    std::size_t node_count = 0, leaf_count = 0; ///< inner nodes, blocks
    std::size_t lane_count = 0; ///< primitives in blocks; more than there are after spatial splits
    int depth = 0;              ///< of the deepest block, the root being 0
    double sah_cost = 0;        ///< C_t = C_i = 1, relative to the root's area; 0 where that is 0

    [[nodiscard]] WideView view() const;
};

} // namespace plumb
