/// \file  The compact SAH tree as kernels see it: plain arrays, host and device.
///
/// A node of 64 bytes (one cache line) holds the boxes of both its children, so that one fetch
/// decides about two boxes; a leaf is one block of up to eight triangles, or a run of spheres, with
/// copies of their vertices, so that a leaf touches consecutive memory only.
#pragma once

#include "accel/geometry.h"

#include <type_traits>

namespace plumb {

inline constexpr int sah_max_depth = 64;              ///< of a leaf, the root being 0
inline constexpr std::uint32_t sah_max_leaf_size = 8; ///< primitives

/// A child of a node: another node, up to eight triangles, or up to eight spheres.
struct ChildRef {
    std::uint32_t first; ///< index of the node, of the triangle block, or of the first sphere
    std::uint32_t info;  ///< 0 for a node; else a leaf: flags and number of primitives

    static constexpr std::uint32_t leaf_flag = 0x80000000u, sphere_flag = 0x40000000u;

    [[nodiscard]] RT_HD static ChildRef node(std::uint32_t index) { return {index, 0}; }
    [[nodiscard]] RT_HD static ChildRef triangle_leaf(std::uint32_t block, std::uint32_t count) {
        return {block, leaf_flag | count};
    }
    [[nodiscard]] RT_HD static ChildRef sphere_leaf(std::uint32_t first, std::uint32_t count) {
        return {first, leaf_flag | sphere_flag | count};
    }
    [[nodiscard]] RT_HD bool is_leaf() const { return info != 0; }
    [[nodiscard]] RT_HD bool has_spheres() const { return (info & sphere_flag) != 0; }
    [[nodiscard]] RT_HD std::uint32_t count() const { return info & ~(leaf_flag | sphere_flag); }
};

/// planes[axis] = {lower of child 0, lower of child 1, upper of child 0, upper of child 1}: the
/// near planes of both children are neighbours, and so are the far ones.
struct alignas(64) SahNode {
    float planes[3][4];
    ChildRef child[2];

    [[nodiscard]] RT_HD Bounds bounds(int i) const {
        return {{planes[0][i], planes[1][i], planes[2][i]},
                {planes[0][2 + i], planes[1][2 + i], planes[2][2 + i]}};
    }
};
static_assert(sizeof(SahNode) == 64);

/// Up to eight triangles, transposed: eight lanes of each coordinate. Lanes without a triangle hold
/// zeros.
struct alignas(32) TriangleBlock {
    float vertex[3][3][sah_max_leaf_size]; ///< [a, b, c][axis][lane]
    std::uint32_t geometry[sah_max_leaf_size], primitive[sah_max_leaf_size];

    [[nodiscard]] RT_HD Vec3 corner(int i, std::uint32_t lane) const {
        return {vertex[i][0][lane], vertex[i][1][lane], vertex[i][2][lane]};
    }
};

struct SahSphere {
    Sphere sphere;
    std::uint32_t primitive;
};

/// A tree without primitives has one node with two empty boxes. nodes[0] is the root.
struct SahView {
    const SahNode* nodes = nullptr;
    const TriangleBlock* blocks = nullptr;
    const SahSphere* spheres = nullptr;
    std::uint32_t node_count = 0, block_count = 0, sphere_count = 0;
    std::uint32_t sphere_geometry = 0; ///< the geometry id of all spheres
};
static_assert(std::is_trivially_copyable_v<SahView>);

} // namespace plumb
