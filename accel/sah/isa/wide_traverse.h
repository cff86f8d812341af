/// \file  Closest-hit and any-hit traversal of the 8-wide tree, for one instruction set a file.
///
/// Boxes are culled conservatively (wide_ray.h) and with near <= best t inclusive, and every hit
/// lies in the slab interval of its primitive's own box (settle), so the hit returned is the same
/// for any tree, any order and any instruction set.
#pragma once

#include "accel/intersector.h"
#include "accel/sah/isa/enter_children.h"
#include "accel/sah/isa/triangle_lanes.h"
#include "accel/sah/numbered_hit.h"

namespace plumb {
namespace {

/// Which children of a node a ray enters, and where.
template <class V> class NodeTest {
  public:
    using Floats = typename V::Floats;

    /// A WideRay, or a PacketHull.
    template <class R> explicit NodeTest(const R& ray) : tmin_(V::broadcast(ray.tmin)) {
        for (int axis = 0; axis < 3; ++axis) {
            near_inverse_[axis] = V::broadcast(ray.near_inverse[axis]);
            near_addend_[axis] = V::broadcast(ray.near_addend[axis]);
            far_inverse_[axis] = V::broadcast(ray.far_inverse[axis]);
            far_addend_[axis] = V::broadcast(ray.far_addend[axis]);
            const std::ptrdiff_t negative = ray.negative >> axis & 1u;
            near_[axis] = wide_width * (2 * axis + negative);
            far_[axis] = wide_width * (2 * axis + 1 - negative);
        }
    }

    /// A bit for each child that is entered at or before `tmax`; where, in `near`.
    unsigned operator()(const WideNode& node, Floats tmax, Floats& near) const {
        return (*this)(&node.planes[0][0][0], tmax, near);
    }
    /// The same for eight boxes that lie as a node's.
    unsigned operator()(const float* planes, Floats tmax, Floats& near) const {
        const auto at = [&](const std::ptrdiff_t* offset, const Floats* inverse,
                            const Floats* addend, int axis) {
            return V::multiply_add(V::load(planes + offset[axis]), inverse[axis], addend[axis]);
        };
        near = V::max(V::max(at(near_, near_inverse_, near_addend_, 0),
                             at(near_, near_inverse_, near_addend_, 1)),
                      V::max(at(near_, near_inverse_, near_addend_, 2), tmin_));
        const Floats far = V::min(
            V::min(at(far_, far_inverse_, far_addend_, 0), at(far_, far_inverse_, far_addend_, 1)),
            V::min(at(far_, far_inverse_, far_addend_, 2), tmax));
        return V::bits(V::not_greater(near, far));
    }

  private:
    Floats near_inverse_[3], near_addend_[3], far_inverse_[3], far_addend_[3], tmin_;
    std::ptrdiff_t near_[3], far_[3]; ///< where a node keeps these planes of an axis
};

/// Calls visit(number, hit) for hits of a leaf until it returns true. Returns whether it did.
template <class V, TriangleTest Test, class Visit>
[[gnu::always_inline]] inline bool visit_leaf(const WideView& tree, WideRef leaf,
                                              const WideRay& ray, float tmax, Visit&& visit) {
    if (leaf.has_spheres()) {
        const auto& block = tree.at<WideSpheres>(leaf);
        const PreparedRay prepared = ray.prepared();
        PrimitiveHit hit;
        for (std::size_t lane = 0; lane < wide_width; ++lane) {
            if (lane > 0 && block.number[lane] == block.number[lane - 1])
                break; // filled up
            if (intersect_sphere(prepared, block.sphere[lane], tmax, hit) &&
                visit(block.number[lane], hit))
                return true;
        }
        return false;
    }
    const auto& block = tree.at<WideTriangles>(leaf);
    return visit_triangles<V, Test>(
        ray, block, tmax,
        [&](std::size_t lane, const PrimitiveHit& hit) { return visit(block.number[lane], hit); });
}

/// Counts nothing; compiles to nothing.
struct NoCounter {
    void node() const {}
    void leaf(const WideView& /*tree*/, WideRef /*leaf*/) const {}
};

struct Counter {
    TraversalCounts* counts;

    void node() const { ++counts->nodes; }
    void leaf(const WideView& tree, WideRef leaf) const {
        ++counts->leaves;
        const PrimitiveNumber* number = tree.numbers(leaf);
        ++counts->triangles;
        for (int lane = 1; lane < wide_width; ++lane)
            counts->triangles += number[lane] != number[lane - 1] ? 1u : 0u;
    }
};

/// Looks for closer hits than `best` below `current`, in a tree that is not empty.
template <class V, TriangleTest Test, Guess G, class Counter>
inline void find_closest(const WideView& tree, const WideRay& wide, WideRef current,
                         NumberedHit& best, Counter count) {
    const NodeTest<V> test(wide);
    StackEntry stack[wide_max_stack];
    int size = 0;
    typename V::Floats limit = V::broadcast(best.t);
    for (;;) {
        if (!current.is_leaf()) {
            const auto& node = tree.at<WideNode>(current);
            count.node();
            typename V::Floats near;
            const unsigned mask = test(node, limit, near);
            if (mask != 0) {
                current = enter_children<V, G>(tree, node, mask, near, stack, size);
                continue;
            }
        } else {
            count.leaf(tree, current);
            visit_leaf<V, Test>(tree, current, wide, best.t,
                                [&](PrimitiveNumber number, const PrimitiveHit& hit) {
                                    best.keep_closer(hit, number);
                                    return false;
                                });
            limit = V::broadcast(best.t);
        }
        do {
            if (size == 0)
                return;
            --size;
        } while (near_of(stack[size]) > best.t);
        current = ref_of(stack[size]);
    }
}

/// Whether there is any hit below `current`, in a tree that is not empty.
template <class V, TriangleTest Test, Guess G, class Counter>
inline bool find_any(const WideView& tree, const WideRay& wide, WideRef current, Counter count) {
    const NodeTest<V> test(wide);
    const typename V::Floats limit = V::broadcast(wide.tmax);
    std::uint32_t stack[wide_max_stack]; // not WideRefs, which would be set to zero first
    int size = 0;
    for (;;) {
        if (!current.is_leaf()) {
            const auto& node = tree.at<WideNode>(current);
            count.node();
            typename V::Floats near;
            const unsigned mask = test(node, limit, near);
            if (mask != 0) {
                push_children<V, G>(tree, node, mask & (mask - 1), stack, size);
                current = child_at<G>(node, static_cast<unsigned>(std::countr_zero(mask)));
                continue;
            }
        } else {
            count.leaf(tree, current);
            if (visit_leaf<V, Test>(tree, current, wide, wide.tmax,
                                    [](PrimitiveNumber, const PrimitiveHit&) { return true; }))
                return true;
        }
        if (size == 0)
            return false;
        current = WideRef{stack[--size]};
    }
}

/// For rays that are ordinary (WideRay::is_ordinary) and trees that are not empty.
template <class V, TriangleTest Test, Guess G, class Counter>
NumberedHit closest_ordinary(const WideView& tree, const Ray& ray, Counter count) {
    const WideRay wide(ray, tree.reach);
    NumberedHit best(ray.tmax);
    find_closest<V, Test, G>(tree, wide, WideRef{}, best, count);
    return best;
}

template <class V, TriangleTest Test, Guess G, class Counter>
bool occluded_ordinary(const WideView& tree, const Ray& ray, Counter count) {
    return find_any<V, Test, G>(tree, WideRay(ray, tree.reach), WideRef{}, count);
}

} // namespace
} // namespace plumb
