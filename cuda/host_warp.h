/// \file  The lanes of a warp in a loop on the host: what a device does in step.
#pragma once

#include "cuda/persistent.h"

#include <memory>

namespace plumb {

/// The Warp of trace_persistently.
template <TriangleTest Test> class HostWarp {
  public:
    template <class F> void each(F&& f) {
        for (std::uint32_t i = 0; i < warp_lanes; ++i)
            f(lanes_->of[i].lane, lanes_->of[i].stack, i);
    }
    template <class F> [[nodiscard]] std::uint32_t vote(F&& f) const {
        std::uint32_t votes = 0;
        for (std::uint32_t i = 0; i < warp_lanes; ++i)
            votes |= f(lanes_->of[i].lane) ? 1u << i : 0u;
        return votes;
    }
    [[nodiscard]] static std::uint32_t take(std::uint32_t& counter, std::uint32_t n) {
        counter += n;
        return counter - n;
    }

  private:
    struct Lanes {
        struct {
            PersistentLane<Test> lane;
            typename PersistentLane<Test>::Stack stack;
        } of[warp_lanes];
    };
    std::unique_ptr<Lanes> lanes_ = std::make_unique<Lanes>();
};

/// As many warps as a device holds, one after the other; one would do.
template <TriangleTest Test, class Items>
void trace_persistently_on_host(const CompressedView& view, const Items& items,
                                std::uint32_t& taken) {
    for (int warp = 0; warp < 2; ++warp)
        trace_persistently(HostWarp<Test>(), view, items, taken);
}

} // namespace plumb
