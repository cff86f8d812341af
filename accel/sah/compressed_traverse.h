/// \file  Closest-hit and any-hit traversal of the compressed tree, single source for host and
/// device.
///
/// Ylitie, Karras, Laine 2017, algorithm 1: children are met in the order of their slots, turned by
/// the signs of the ray's direction; what is still to be done of one node is a word of bits. The
/// hit is the same for any order (see sah_traverse.h).
#pragma once

#include "accel/math/bits.h"
#include "accel/sah/compressed_test.h"
#include "accel/sah/sah_traverse.h"

namespace plumb {
namespace detail {

/// x. What is computed of it on a device is computed where that stands.
RT_HD inline float computed_here(float x) {
#ifdef __CUDA_ARCH__
    asm volatile("" : "+f"(x));
#endif
    return x;
}

/// `Resumed`: the ray is one of many that take turns, so that what a compiler takes out of the
/// branch for spheres, as doubles of the direction, every lane would compute in every turn.
template <TriangleTest Test, bool Resumed>
RT_HD inline bool intersect(const PreparedRay& ray, const CompressedPrimitive& p, float tmax,
                            PrimitiveHit& hit) {
    if (p.is_sphere != 0) {
        PreparedRay here = ray;
        if constexpr (Resumed)
            here.direction = {computed_here(ray.direction.x), computed_here(ray.direction.y),
                              computed_here(ray.direction.z)};
        return intersect_sphere(here, Sphere{p.a, p.b.x}, tmax, hit);
    }
    return intersect_triangle<Test>(ray, p.a, p.b, p.c, tmax, hit);
}

/// How many primitives of a node are tested before lanes of a warp go on to nodes together: with
/// all of them, lanes without primitives would wait for the one that has most (tools/warps).
inline constexpr int primitives_a_turn = 2;

/// A ray on its way through the tree, in turns: some primitives of the node before, then a node.
/// Its stack is apart, since a device can keep all but that in registers.
template <TriangleTest Test, bool Resumed = false> class CompressedWalk {
  public:
    using Stack = NodeGroup[compressed_max_depth];

    /// The ray must be valid.
    RT_HD CompressedWalk(const CompressedView& view, const Ray& ray)
        : prepared_(ray), test_(prepared_, is_plain(ray, view.reach), view.one) {}

    /// Calls visit(hit, primitive) for hits; `best_t` may shrink meanwhile. False: nothing is left
    /// to do, or visit returned true.
    ///
    /// No lane of a warp comes back here before the others have done their turn: one that took
    /// from its stack would otherwise wait for all that go down.
    template <class Tally, class Visit>
    RT_HD bool turn(const CompressedView& view, Stack& stack, const float& best_t, Tally& tally,
                    Visit&& visit) {
        for (int i = 0; i < primitives_a_turn && left_ != 0; ++i, left_ &= left_ - 1) {
            const std::uint32_t primitive = first_primitive_ + lowest_one(left_);
            const CompressedPrimitive p = view.primitives[primitive];
            PrimitiveHit hit;
            tally.primitive(primitive);
            if (intersect<Test, Resumed>(prepared_, p, best_t, hit) && visit(hit, p))
                return false;
            test_.limit(best_t);
        }
        bool goes_on = true;
        if (left_ == 0 && (group_.bits & NodeGroup::todo) == 0) {
            goes_on = size_ > 0;
            if (goes_on)
                group_ = stack[--size_];
        }
        if (left_ == 0 && goes_on)
            go_down(view, stack, tally);
        return goes_on;
    }

  private:
    template <class Tally>
    RT_HD void go_down(const CompressedView& view, Stack& stack, Tally& tally) {
        const std::uint32_t place = highest_one(group_.bits);
        const std::uint32_t slot = (place - 24) ^ test_.turn();
        const std::uint32_t before = ones(group_.bits & 0xffu & ((1u << slot) - 1));
        group_.bits &= ~(1u << place);
        const std::uint32_t index = group_.first + before;
        const CompressedNode node = view.nodes[index]; // whole: five wide loads
        if ((group_.bits & NodeGroup::todo) != 0)
            stack[size_++] = group_;
        tally.node(index);
        const std::uint32_t hits = test_(node, view.nodes[index]);
        group_ = {node.first_child, (hits & NodeGroup::todo) | node.inner_mask()};
        first_primitive_ = node.first_primitive;
        left_ = hits & ~NodeGroup::todo;
    }

    PreparedRay prepared_;
    CompressedTest test_;
    int size_ = 0;
    NodeGroup group_{0, 0x80000000u};              ///< the root: no slot before it holds a node
    std::uint32_t first_primitive_ = 0, left_ = 0; ///< of the node before: bits as CompressedTest's
};

} // namespace detail

/// Closest hit of one ray. An invalid ray misses.
template <TriangleTest Test, class Tally = NoTally>
[[nodiscard]] RT_HD inline Hit closest(const CompressedView& view, const Ray& ray,
                                       Tally&& tally = {}) {
    Hit best;
    if (!is_valid(ray))
        return best;
    best.t = ray.tmax;
    const auto keep = [&best](const PrimitiveHit& hit, const CompressedPrimitive& p) {
        detail::keep_closer(hit, p.geometry, p.primitive, best);
        return false;
    };
    typename detail::CompressedWalk<Test>::Stack stack;
    detail::CompressedWalk<Test> walk(view, ray);
    while (walk.turn(view, stack, best.t, tally, keep)) {
    }
    if (!best.valid())
        best.t = infinity;
    return best;
}

/// Whether any hit exists; equal to closest(view, ray).valid().
template <TriangleTest Test, class Tally = NoTally>
[[nodiscard]] RT_HD inline bool occluded(const CompressedView& view, const Ray& ray,
                                         Tally&& tally = {}) {
    if (!is_valid(ray))
        return false;
    bool found = false;
    const auto stop = [&found](const PrimitiveHit&, const CompressedPrimitive&) {
        return found = true;
    };
    typename detail::CompressedWalk<Test>::Stack stack;
    detail::CompressedWalk<Test> walk(view, ray);
    while (walk.turn(view, stack, ray.tmax, tally, stop)) {
    }
    return found;
}

} // namespace plumb
