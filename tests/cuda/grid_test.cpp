/// \file  Every item of a launch gets exactly one thread.

#include "cuda/grid.h"

#include <gtest/gtest.h>
#include <vector>

namespace plumb {
namespace {

TEST(Grid, ShapeIsTheLeastThatHasAThreadForEveryItem) {
    for (const std::uint64_t items : {0ull, 1ull, 127ull, 128ull, 129ull, 1000ull, 1ull << 32})
        for (const std::uint32_t block_size : {1u, 32u, 128u}) {
            if (items / block_size >= 1ull << 31)
                continue; // beyond what a device launches
            const LaunchShape shape = shape_for(items, block_size);
            const std::uint64_t threads = std::uint64_t{shape.blocks} * shape.block_size;
            EXPECT_GE(threads, items);
            EXPECT_LT(threads, items + block_size);
        }
}

TEST(Grid, EveryIndexIsVisitedOnce) {
    constexpr std::uint64_t items = 1000;
    std::vector<int> visits(1024, 0);
    run_grid_on_host(shape_for(items, 128), [&](GridPosition at) { ++visits.at(at.index()); });
    for (const int n : visits)
        EXPECT_EQ(n, 1);
}

TEST(Grid, IndexDoesNotOverflow32Bits) {
    const GridPosition last{(1u << 31) - 1, 127, 128};
    EXPECT_EQ(last.index(), (std::uint64_t{1} << 38) - 1);
}

} // namespace
} // namespace plumb
