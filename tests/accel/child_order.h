/// \file  What push_sorted of any lanes has to write: the children that are entered, farthest
/// first.
#pragma once

#include "accel/sah/isa/enter_children.h"
#include "tests/support/random.h"

#include <cmath>
#include <gtest/gtest.h>

namespace plumb::test {

/// Distances of children: most of them spread, some equal, 0, next to each other or far.
inline float child_distance(Random& random) {
    switch (random.index(6)) {
    case 0: return 0;
    case 1: return 1;
    case 2: return std::nextafter(1.0f, 2.0f);
    case 3: return std::exp2(random.uniform(-100, 100));
    default: return random.uniform(0, 2);
    }
}

/// Every set of children, many times.
template <class V> void expect_children_in_order(int rounds) {
    Random random(41);
    for (int round = 0; round < rounds; ++round)
        for (unsigned mask = 0; mask < 256; ++mask) {
            alignas(32) float near[wide_width], flag[wide_width];
            alignas(32) std::uint32_t child[wide_width];
            for (unsigned lane = 0; lane < wide_width; ++lane) {
                near[lane] = child_distance(random);
                flag[lane] = (mask >> lane & 1u) != 0 ? 0.0f : 1.0f;
                child[lane] = random.index(0x7fffffffu) << 3 | lane;
            }
            StackEntry stack[1 + 2 * wide_width];
            stack[0] = 17;
            const auto entered = V::equal(V::load(flag), V::broadcast(0));
            const int count = V::push_sorted(stack + 1, V::load(near), entered, child);
            ASSERT_EQ(count, std::popcount(mask));
            EXPECT_EQ(stack[0], 17u); // what lies below
            unsigned seen = 0;
            for (int i = 1; i <= count; ++i) {
                const unsigned lane = ref_of(stack[i]).bits & 7u;
                seen |= 1u << lane;
                EXPECT_EQ(ref_of(stack[i]).bits, child[lane]);
                // Not behind the box, or a tie would be lost; before it by a rounding error.
                EXPECT_LE(near_of(stack[i]), near[lane]);
                EXPECT_GE(near_of(stack[i]), near[lane] * (1 - 0x1p-20f));
                if (i > 1) {
                    EXPECT_GE(near_of(stack[i - 1]), near_of(stack[i]));
                }
            }
            EXPECT_EQ(seen, mask);
        }
}

} // namespace plumb::test
