/// \file  Closest-hit and any-hit traversal of the SAH tree, single source for host and device.
///
/// Boxes are culled with near <= best t inclusive, and every hit lies in the slab interval of its
/// primitive's own box (settle), so the hit returned is the same for any tree and any order.
#pragma once

#include "accel/sah/child_test.h"

namespace plumb {

/// What a traversal tells of its steps: nothing. Tests and roof-line counts pass one that counts.
struct NoTally {
    RT_HD void node() {}
    RT_HD void primitive() {}
};

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
    if (hit.t < best.t || (hit.t == best.t && lower_id))
        best = {hit.t, hit.u, hit.v, geometry, primitive, invalid_id};
}

/// Calls visit(hit, geometry, primitive) for hits of a leaf's spheres until it returns true.
template <class Visit>
RT_HD inline bool visit_spheres(const SahView& view, ChildRef leaf, const PreparedRay& ray,
                                float tmax, Visit&& visit) {
    PrimitiveHit hit;
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count(); ++i)
        if (intersect_sphere(ray, view.spheres[i].sphere, tmax, hit) &&
            visit(hit, view.sphere_geometry, view.spheres[i].primitive))
            return true;
    return false;
}

/// The same for any leaf.
template <TriangleTest Test, class Visit>
RT_HD inline bool visit_leaf(const SahView& view, ChildRef leaf, const PreparedRay& ray, float tmax,
                             Visit&& visit) {
    if (leaf.has_spheres())
        return visit_spheres(view, leaf, ray, tmax, visit);
    const TriangleBlock& block = view.blocks[leaf.first];
    PrimitiveHit hit;
    for (std::uint32_t lane = 0; lane < leaf.count(); ++lane)
        if (intersect_triangle<Test>(ray, block.corner(0, lane), block.corner(1, lane),
                                     block.corner(2, lane), tmax, hit) &&
            visit(hit, block.geometry[lane], block.primitive[lane]))
            return true;
    return false;
}

/// A leaf's primitives one by one, whichever ends the visit.
template <class Tally> RT_HD inline void tally_leaf(ChildRef leaf, Tally& tally) {
    for (std::uint32_t i = 0; i < leaf.count(); ++i)
        tally.primitive();
}

} // namespace detail

/// Closest hit of one ray. An invalid ray misses.
template <TriangleTest Test, class Tally = NoTally>
[[nodiscard]] RT_HD inline Hit closest(const SahView& view, const Ray& ray, Tally&& tally = {}) {
    if (!is_valid(ray))
        return {};
    const PreparedRay prepared(ray);
    ChildTest test(prepared);
    detail::StackEntry stack[sah_max_depth];
    int size = 0;
    Hit best;
    best.t = ray.tmax;
    ChildRef current = ChildRef::node(0);
    for (;;) {
        if (!current.is_leaf()) {
            const SahNode node = view.nodes[current.first]; // whole: four wide loads
            tally.node();
            const ChildOverlap overlap = test(node);
            if (overlap.mask != 0) {
                // The nearer child now, the other later.
                if (overlap.mask == 1) {
                    current = node.child[0];
                } else if (overlap.mask == 2) {
                    current = node.child[1];
                } else if (overlap.near[1] < overlap.near[0]) {
                    stack[size++] = {node.child[0], overlap.near[0]};
                    current = node.child[1];
                } else {
                    stack[size++] = {node.child[1], overlap.near[1]};
                    current = node.child[0];
                }
                continue;
            }
        } else {
            const auto keep = [&](const PrimitiveHit& hit, std::uint32_t geometry,
                                  std::uint32_t primitive) {
                detail::keep_closer(hit, geometry, primitive, best);
                return false;
            };
            detail::tally_leaf(current, tally);
            detail::visit_leaf<Test>(view, current, prepared, best.t, keep);
            test.limit(best.t);
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
template <TriangleTest Test, class Tally = NoTally>
[[nodiscard]] RT_HD inline bool occluded(const SahView& view, const Ray& ray, Tally&& tally = {}) {
    if (!is_valid(ray))
        return false;
    const PreparedRay prepared(ray);
    const ChildTest test(prepared);
    ChildRef stack[sah_max_depth];
    int size = 0;
    ChildRef current = ChildRef::node(0);
    for (;;) {
        if (!current.is_leaf()) {
            const SahNode node = view.nodes[current.first]; // whole: four wide loads
            tally.node();
            const unsigned mask = test(node).mask;
            if (mask != 0) {
                if (mask == 3)
                    stack[size++] = node.child[1];
                current = mask == 2 ? node.child[1] : node.child[0];
                continue;
            }
        } else {
            detail::tally_leaf(current, tally);
            const auto any = [](const PrimitiveHit&, std::uint32_t, std::uint32_t) { return true; };
            if (detail::visit_leaf<Test>(view, current, prepared, ray.tmax, any))
                return true;
        }
        if (size == 0)
            return false;
        current = stack[--size];
    }
}

} // namespace plumb
