/// \file  Which rays a warp gets: blocks in turns over the multiprocessors, and rays sorted before.
#pragma once

#include "cuda/persistent.h"
#include "tools/warp_src/multiprocessor.h"

#include <array>

namespace plumb::warps {

/// The multiprocessors that are looked at, out of all that share the work.
inline constexpr std::array<std::uint32_t, 3> looked_at{0, 44, 88};

/// Calls take(first, end) for each warp's items of a launch that multiprocessor `number` gets:
/// blocks in their order, each to the next multiprocessor.
template <class Take>
void for_warps(const Gpu& gpu, std::uint32_t number, std::size_t items, Take&& take) {
    constexpr std::size_t block = Gpu::lanes * Gpu::warps_of_block;
    const auto all = static_cast<std::size_t>(gpu.multiprocessors);
    for (std::size_t first = number * block; first < items; first += all * block)
        for (std::size_t warp = first; warp < std::min(first + block, items); warp += Gpu::lanes)
            take(warp, std::min(warp + Gpu::lanes, items));
}

/// One ray a thread.
[[nodiscard]] std::vector<WarpWork> warps_of(const Gpu& gpu, std::uint32_t number,
                                             std::span<const Question> rays, const Cost& besides);

/// The rays of all warps, for persistent threads, which are refilled at so many lanes.
[[nodiscard]] std::vector<Question> queue_of(std::span<const WarpWork> warps);
inline constexpr std::uint32_t persistent_refill_at = warp_lanes - refill_from;

/// Sorts by the octant of the direction, then along a Z curve of 10 bits an axis through the box of
/// the origins.
void sort_rays(std::vector<Question>& rays);

} // namespace plumb::warps
