/// \file  A ray between two steps through the 8-wide tree.
#pragma once

#include "accel/sah/isa/wide_traverse.h"

#include <type_traits>

namespace plumb {
namespace {

/// `AnyHit`: it ends at its first hit.
template <class V, TriangleTest Test, bool AnyHit> class alignas(64) InterleavedRay {
  public:
    /// An ordinary ray, before a tree that is not empty. `index`: its number in the stream.
    InterleavedRay(const WideView& tree, const Ray& ray, std::uint32_t index)
        : wide_(ray, tree.reach), best_(ray.tmax), index_(index) {
        stack_[0] = done.bits; // entered at 0
        for (unsigned axis = 0; axis < 3; ++axis) {
            const int negative = static_cast<int>(wide_.negative >> axis & 1u);
            near_[axis] = wide_width * negative;
            far_[axis] = wide_width * (1 - negative);
        }
    }

    [[nodiscard]] std::uint32_t index() const { return index_; }
    [[nodiscard]] const NumberedHit& best() const { return best_; }
    [[nodiscard]] bool is_done() const { return current_.bits == done.bits; }
    /// What the next step visits; a leaf of spheres where nothing is left.
    [[nodiscard]] WideRef current() const { return current_; }

    /// Three kinds of steps, by what current() is. Each fetches what the next one visits.
    [[gnu::always_inline]] void visit_node(const WideView& tree) {
        const auto& node = tree.at<WideNode>(current_);
        const auto enter = [&](std::size_t axis) {
            return V::multiply_add(V::load(node.planes[axis][0] + near_[axis]),
                                   V::broadcast(wide_.near_inverse[axis]),
                                   V::broadcast(wide_.near_addend[axis]));
        };
        const auto leave = [&](std::size_t axis) {
            return V::multiply_add(V::load(node.planes[axis][0] + far_[axis]),
                                   V::broadcast(wide_.far_inverse[axis]),
                                   V::broadcast(wide_.far_addend[axis]));
        };
        const auto near =
            V::max(V::max(enter(0), enter(1)), V::max(enter(2), V::broadcast(wide_.tmin)));
        const auto far =
            V::min(V::min(leave(0), leave(1)), V::min(leave(2), V::broadcast(best_.t)));
        const auto entered = V::not_greater(near, far);
        if constexpr (AnyHit) {
            const unsigned mask = V::bits(entered);
            V::store_packed(stack_ + size_, &node.child[0].bits, mask);
            size_ += std::popcount(mask);
        } else {
            size_ += V::push_sorted(stack_ + size_, near, entered, &node.child[0].bits);
        }
        pop(tree);
    }
    [[gnu::always_inline]] void visit_triangle_block(const WideView& tree) {
        const auto& block = tree.at<WideTriangles>(current_);
        const float limit = best_.t;
        visit_triangles<V, Test>(wide_, block, limit,
                                 [&](std::size_t lane, const PrimitiveHit& hit) {
                                     return keep(block.number[lane], hit);
                                 });
        end_leaf(tree, limit);
    }
    void visit_sphere_block(const WideView& tree) {
        const float limit = best_.t;
        visit_leaf<V, Test>(
            tree, current_, wide_, limit,
            [&](PrimitiveNumber number, const PrimitiveHit& hit) { return keep(number, hit); });
        end_leaf(tree, limit);
    }

  private:
    /// Any hit needs no order, and is found sooner without one among boxes that overlap.
    using Entry = std::conditional_t<AnyHit, std::uint32_t, StackEntry>;

    /// At the bottom of the stack. The root lies there, so no leaf does.
    static constexpr WideRef done{WideRef::leaf_flag | WideRef::sphere_flag};

    [[gnu::always_inline]] bool keep(PrimitiveNumber number, const PrimitiveHit& hit) {
        best_.keep_closer(hit, number);
        return AnyHit;
    }
    /// Children that a closer hit hides leave the stack at once: then no child that is popped has
    /// to be asked, which is a jump that the processor would guess wrong.
    [[gnu::always_inline]] void end_leaf(const WideView& tree, float limit) {
        if (AnyHit && best_.number != invalid_id)
            size_ = 1; // done
        if constexpr (!AnyHit)
            if (best_.t < limit)
                drop_farther();
        pop(tree);
    }
    void drop_farther() {
        int kept = 1;
        for (int i = 1; i < size_; ++i) {
            const StackEntry entry = stack_[i];
            stack_[kept] = entry;
            kept += near_of(entry) <= best_.t ? 1 : 0;
        }
        size_ = kept;
    }
    [[gnu::always_inline]] void pop(const WideView& tree) {
        current_ = WideRef{static_cast<std::uint32_t>(stack_[--size_])};
        const char* lines = reinterpret_cast<const char*>(&tree.at<WideTriangles>(current_));
        for (std::size_t i = 0; i < sizeof(WideTriangles); i += WideView::unit_bytes)
            _mm_prefetch(lines + i, _MM_HINT_T0); // a node is shorter by a line
    }

    WideRay wide_;
    std::int32_t near_[3], far_[3]; ///< where a node keeps these planes, from its axis on
    NumberedHit best_;
    WideRef current_{};
    std::uint32_t index_;
    int size_ = 1;
    Entry stack_[1 + wide_max_stack + wide_width]; ///< pushing writes beyond the end
};

} // namespace
} // namespace plumb
