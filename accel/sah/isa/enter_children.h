/// \file  From the children that a ray enters to the next one, nearest first.
#pragma once

#include "accel/sah/wide_bvh.h"

#include <bit>
#include <xmmintrin.h>

namespace plumb {
namespace {

/// How the next child is found. `branch`: jumps on what the box test says, so that the processor
/// guesses it and fetches the child before the test is done; best where a ray does what the one
/// before it did. `select`: no jumps, and children are prefetched when they are pushed; best where
/// guesses would be wrong. The hits are the same.
enum class Guess : std::uint8_t { branch, select };

/// A child and where it is entered, as one number that sorts by the distance: its bits above, the
/// reference below. Distances are not negative.
using StackEntry = std::uint64_t;

inline StackEntry stack_entry(WideRef ref, float near) {
    return StackEntry{std::bit_cast<std::uint32_t>(near)} << 32 | ref.bits;
}
inline WideRef ref_of(StackEntry entry) { return {static_cast<std::uint32_t>(entry)}; }
inline float near_of(StackEntry entry) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(entry >> 32));
}

/// at(lane), found by a jump for each lane, which the processor guesses.
template <class At> [[gnu::always_inline]] inline auto by_jump(unsigned lane, At&& at) {
    // The empty statements differ, or the compiler would merge the cases into a computed address.
    switch (lane) {
    case 0: asm volatile("# child 0"); return at(0);
    case 1: asm volatile("# child 1"); return at(1);
    case 2: asm volatile("# child 2"); return at(2);
    case 3: asm volatile("# child 3"); return at(3);
    case 4: asm volatile("# child 4"); return at(4);
    case 5: asm volatile("# child 5"); return at(5);
    case 6: asm volatile("# child 6"); return at(6);
    case 7: asm volatile("# child 7"); return at(7);
    default: __builtin_unreachable();
    }
}

/// The child in `lane`.
template <Guess G>
[[gnu::always_inline]] inline WideRef child_at(const WideNode& node, unsigned lane) {
    if constexpr (G == Guess::select)
        return node.child[lane];
    return by_jump(lane, [&node](unsigned i) { return node.child[i]; });
}

/// Fetches a child that will be visited later.
template <Guess G> [[gnu::always_inline]] inline void prefetch(const WideView& tree, WideRef ref) {
    if constexpr (G == Guess::select) {
        const char* lines = reinterpret_cast<const char*>(&tree.at<WideNode>(ref));
        for (std::size_t i = 0; i < sizeof(WideNode); i += WideView::unit_bytes)
            _mm_prefetch(lines + i, _MM_HINT_T0);
    }
}

/// Pushes the children in `mask`, which may be none, in any order.
template <class V, Guess G>
[[gnu::always_inline]] inline void push_children(const WideView& tree, const WideNode& node,
                                                 unsigned mask, std::uint32_t* stack, int& size) {
    if constexpr (G == Guess::select)
        for (unsigned rest = mask; rest != 0; rest &= rest - 1)
            prefetch<G>(tree, node.child[std::countr_zero(rest)]);
    V::store_packed(stack + size, &node.child[0].bits, mask); // without a loop
    size += std::popcount(mask);
}

/// Puts the nearer of two first, without a jump.
inline void order(StackEntry& a, StackEntry& b) {
    const StackEntry low = a < b ? a : b, high = a < b ? b : a;
    a = low;
    b = high;
}

/// Pushes all children in `mask` (at least one) but the nearest, farthest first, and returns the
/// nearest. `near`: where the lanes in `mask` are entered.
template <class V, Guess G>
[[gnu::always_inline]] inline WideRef enter_children(const WideView& tree, const WideNode& node,
                                                     unsigned mask, typename V::Floats near,
                                                     StackEntry* stack, int& size) {
    const auto take = [&] {
        const auto lane = static_cast<unsigned>(std::countr_zero(mask));
        mask &= mask - 1;
        return lane;
    };
    const unsigned first = take();
    if (mask == 0)
        return child_at<G>(node, first);
    alignas(32) float distance[wide_width];
    V::store(distance, near);
    const auto entry = [&](unsigned lane) {
        prefetch<G>(tree, node.child[lane]);
        return stack_entry(node.child[lane], distance[lane]);
    };
    const unsigned second = take();
    if (G == Guess::branch && mask == 0) {
        if (distance[second] < distance[first]) {
            stack[size++] = entry(first);
            return child_at<G>(node, second);
        }
        stack[size++] = entry(second);
        return child_at<G>(node, first);
    }
    StackEntry a = entry(first), b = entry(second);
    order(a, b);
    const auto nearest = [&](StackEntry e) {
        if constexpr (G == Guess::branch)
            return child_at<G>(node, V::find(&node.child[0].bits, static_cast<std::uint32_t>(e)));
        else
            return ref_of(e);
    };
    if (mask == 0) {
        stack[size++] = b;
        return ref_of(a);
    }
    StackEntry c = entry(take());
    order(b, c);
    order(a, b);
    if (mask == 0) {
        stack[size] = c;
        stack[size + 1] = b;
        size += 2;
        return nearest(a);
    }
    StackEntry d = entry(take());
    order(c, d);
    order(b, c);
    order(a, b);
    stack[size] = d;
    stack[size + 1] = c;
    stack[size + 2] = b;
    stack[size + 3] = a;
    const int base = size;
    size += 4;
    while (mask != 0) { // more than four: insertion
        const StackEntry e = entry(take());
        int i = size++;
        for (; i > base && stack[i - 1] < e; --i)
            stack[i] = stack[i - 1];
        stack[i] = e;
    }
    return nearest(stack[--size]);
}

} // namespace
} // namespace plumb
