/// \file  The threads of a launch and how they are numbered; the same grid as loops on the host.
#pragma once

#include "accel/math/host_device.h"

#include <cstdint>

namespace plumb {

/// Where a thread stands in a one-dimensional grid.
struct GridPosition {
    std::uint32_t block, thread, block_size;

    [[nodiscard]] RT_HD std::uint64_t index() const {
        return std::uint64_t{block} * block_size + thread;
    }
};

/// A one-dimensional launch.
struct LaunchShape {
    std::uint32_t blocks, block_size;
};

/// The least number of blocks with a thread for each of `items`, fewer than 2^31 blocks; the last
/// block may be ragged: the body has to test its index. No items: no blocks.
[[nodiscard]] constexpr LaunchShape shape_for(std::uint64_t items, std::uint32_t block_size) {
    return {static_cast<std::uint32_t>((items + block_size - 1) / block_size), block_size};
}

/// Calls body(GridPosition) for every thread of a launch, one after the other: what a device does,
/// for tests without one.
template <class Body> void run_grid_on_host(const LaunchShape& shape, Body&& body) {
    for (std::uint32_t block = 0; block < shape.blocks; ++block)
        for (std::uint32_t thread = 0; thread < shape.block_size; ++thread)
            body(GridPosition{block, thread, shape.block_size});
}

} // namespace plumb
