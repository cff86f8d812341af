/// \file  Closest-hit and any-hit traversal of the SAH tree, single source for host and device.
///
/// Nodes are tested down to the next leaf in a loop of their own: on a device the lanes of a warp
/// meet at leaves (Aila and Laine 2009, "while-while"), where going on as each likes takes up to
/// twice the instructions (tools/warps). Boxes are culled with near <= best t inclusive, and every
/// hit lies in the slab interval of its primitive's own box (settle), so the hit returned is the
/// same for any tree and any order.
#pragma once

#include "accel/sah/child_test.h"

namespace plumb {

/// What a traversal tells of its steps, by their places in the tree's arrays: nothing. Tests,
/// counts and models pass one that listens.
struct NoTally {
    RT_HD void node(std::uint32_t /*index*/) {}
    RT_HD void leaf(ChildRef /*leaf*/) {}            ///< of SahView
    RT_HD void primitive(std::uint32_t /*index*/) {} ///< of CompressedView
};

namespace detail {

/// Takes the last entry of a stack that is_wanted(entry); false where there is none. Array and size
/// apart: a device keeps the size in a register.
template <class Entry, class Wanted>
RT_HD inline bool pop(const Entry* stack, int& size, Entry& entry, Wanted&& is_wanted) {
    while (size > 0) {
        entry = stack[--size];
        if (is_wanted(entry))
            return true;
    }
    return false;
}

/// No member initialisers: a stack of these must cost nothing to declare.
struct NearChild {
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

} // namespace detail

/// Closest hit of one ray. An invalid ray misses.
template <TriangleTest Test, class Tally = NoTally>
[[nodiscard]] RT_HD inline Hit closest(const SahView& view, const Ray& ray, Tally&& tally = {}) {
    if (!is_valid(ray))
        return {};
    const PreparedRay prepared(ray);
    ChildTest test(prepared);
    detail::NearChild stack[sah_max_depth];
    int size = 0;
    Hit best;
    best.t = ray.tmax;
    detail::NearChild entry{ChildRef::node(0), 0};
    const auto is_closer = [&](const detail::NearChild& e) { return e.near <= best.t; };
    for (bool goes_on = true; goes_on;) {
        while (goes_on && !entry.child.is_leaf()) {
            const SahNode node = view.nodes[entry.child.first]; // whole: four wide loads
            tally.node(entry.child.first);
            const ChildOverlap overlap = test(node);
            // The nearer child now, the other later.
            if (overlap.mask == 0) {
                goes_on = detail::pop(stack, size, entry, is_closer);
            } else if (overlap.mask == 1) {
                entry.child = node.child[0];
            } else if (overlap.mask == 2) {
                entry.child = node.child[1];
            } else if (overlap.near[1] < overlap.near[0]) {
                stack[size++] = {node.child[0], overlap.near[0]};
                entry.child = node.child[1];
            } else {
                stack[size++] = {node.child[1], overlap.near[1]};
                entry.child = node.child[0];
            }
        }
        if (!goes_on)
            break;
        tally.leaf(entry.child);
        detail::visit_leaf<Test>(
            view, entry.child, prepared, best.t,
            [&](const PrimitiveHit& hit, std::uint32_t geometry, std::uint32_t primitive) {
                detail::keep_closer(hit, geometry, primitive, best);
                return false;
            });
        test.limit(best.t);
        goes_on = detail::pop(stack, size, entry, is_closer);
    }
    if (!best.valid())
        best.t = infinity;
    return best;
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
    const auto any_child = [](ChildRef) { return true; };
    for (bool goes_on = true; goes_on;) {
        while (goes_on && !current.is_leaf()) {
            const SahNode node = view.nodes[current.first]; // whole: four wide loads
            tally.node(current.first);
            const unsigned mask = test(node).mask;
            if (mask == 3)
                stack[size++] = node.child[1];
            if (mask == 0)
                goes_on = detail::pop(stack, size, current, any_child);
            else
                current = mask == 2 ? node.child[1] : node.child[0];
        }
        if (!goes_on)
            break;
        tally.leaf(current);
        const auto any = [](const PrimitiveHit&, std::uint32_t, std::uint32_t) { return true; };
        if (detail::visit_leaf<Test>(view, current, prepared, ray.tmax, any))
            return true;
        goes_on = detail::pop(stack, size, current, any_child);
    }
    return false;
}

} // namespace plumb
