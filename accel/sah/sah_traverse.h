/// \file  Closest-hit and any-hit traversal of the SAH tree, single source for host and device.
///
/// Boxes are culled with near <= best t inclusive, and every hit lies in the slab interval of its
/// primitive's own box (settle), so the hit returned is the same for any tree and any order.
#pragma once

#include "accel/sah/child_test.h"
#include "accel/sah/leaf_test.h"

namespace plumb {
namespace detail {

/// No member initialisers: a stack of these must cost nothing to declare.
struct StackEntry {
    ChildRef child;
    float near;
};

RT_HD inline void keep_closer(const PrimitiveHit& hit, std::uint32_t geometry,
                              std::uint32_t primitive, Hit& best) {
    const bool lower_id =
        geometry < best.geometry || (geometry == best.geometry && primitive < best.primitive);
    if (hit.t < best.t || lower_id)
        best = {hit.t, hit.u, hit.v, geometry, primitive, invalid_id};
}

/// Requires hit.t <= best.t of every hit it keeps, as the primitive tests guarantee.
template <TriangleTest Test>
RT_HD inline void closest_in_leaf(const SahView& view, ChildRef leaf, const PreparedRay& ray,
                                  Hit& best) {
    PrimitiveHit hit;
    if (leaf.has_spheres()) {
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count(); ++i)
            if (intersect_sphere(ray, view.spheres[i].sphere, best.t, hit))
                keep_closer(hit, view.sphere_geometry, view.spheres[i].primitive, best);
        return;
    }
    const TriangleBlock& block = view.blocks[leaf.first];
    any_candidate<Test>(ray, block, leaf.count(), [&](std::uint32_t lane) {
        if (intersect_triangle<Test>(ray, block.corner(0, lane), block.corner(1, lane),
                                     block.corner(2, lane), best.t, hit))
            keep_closer(hit, block.geometry[lane], block.primitive[lane], best);
        return false;
    });
}

template <TriangleTest Test>
RT_HD inline bool any_in_leaf(const SahView& view, ChildRef leaf, const PreparedRay& ray) {
    PrimitiveHit hit;
    if (leaf.has_spheres()) {
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count(); ++i)
            if (intersect_sphere(ray, view.spheres[i].sphere, ray.tmax, hit))
                return true;
        return false;
    }
    const TriangleBlock& block = view.blocks[leaf.first];
    return any_candidate<Test>(ray, block, leaf.count(), [&](std::uint32_t lane) {
        return intersect_triangle<Test>(ray, block.corner(0, lane), block.corner(1, lane),
                                        block.corner(2, lane), ray.tmax, hit);
    });
}

} // namespace detail

/// Closest hit of one ray. An invalid ray misses.
template <TriangleTest Test>
[[nodiscard]] RT_HD inline Hit closest(const SahView& view, const Ray& ray) {
    if (!is_valid(ray))
        return {};
    const PreparedRay prepared(ray);
    const ChildTest test(prepared);
    detail::StackEntry stack[sah_max_depth];
    int size = 0;
    Hit best;
    best.t = ray.tmax;
    ChildRef current = ChildRef::node(0);
    for (;;) {
        if (!current.is_leaf()) {
            const SahNode& node = view.nodes[current.first];
            const ChildOverlap overlap = test(node, best.t);
            if (overlap.mask != 0) {
                // Both: the nearer one now, the other later. One: that one.
                const bool both = overlap.mask == 3;
                const bool second = both ? overlap.near[1] < overlap.near[0] : overlap.mask == 2;
                stack[size] = {node.child[second ? 0 : 1], overlap.near[second ? 0 : 1]};
                size += both ? 1 : 0;
                current = node.child[second ? 1 : 0];
                continue;
            }
        } else {
            detail::closest_in_leaf<Test>(view, current, prepared, best);
        }
        do {
            if (size == 0) {
                if (!best.valid())
                    best.t = infinity;
                return best;
            }
            --size;
        } while (stack[size].near > best.t);
        current = stack[size].child;
    }
}

/// Whether any hit exists; equal to closest(view, ray).valid().
template <TriangleTest Test>
[[nodiscard]] RT_HD inline bool occluded(const SahView& view, const Ray& ray) {
    if (!is_valid(ray))
        return false;
    const PreparedRay prepared(ray);
    const ChildTest test(prepared);
    ChildRef stack[sah_max_depth];
    int size = 0;
    ChildRef current = ChildRef::node(0);
    for (;;) {
        if (!current.is_leaf()) {
            const SahNode& node = view.nodes[current.first];
            const unsigned mask = test(node, ray.tmax).mask;
            if (mask != 0) {
                stack[size] = node.child[1];
                size += mask == 3 ? 1 : 0;
                current = node.child[mask == 2 ? 1 : 0];
                continue;
            }
        } else if (detail::any_in_leaf<Test>(view, current, prepared)) {
            return true;
        }
        if (size == 0)
            return false;
        current = stack[--size];
    }
}

} // namespace plumb
