/// \file  Persistent threads: lanes of a warp that are done take other rays, host and device.
///
/// T. Aila, S. Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009. As many
/// warps are launched as the device holds at a time; each takes rays from a counter that all share
/// until there are none. Rays without order are done at very different times: without this a lane
/// waits for the longest of its warp. Which lane traces a ray changes no bit of its hit.
#pragma once

#include "accel/sah/compressed_traverse.h"
#include "cuda/grid.h"

namespace plumb {

inline constexpr std::uint32_t warp_lanes = 32;
/// Lanes that are done before they take rays together: each time costs the others a ray's start.
inline constexpr std::uint32_t refill_from = 12;

/// What one lane keeps of its ray. `Items` are the rays of a launch:
///     std::uint32_t count() const;
///     Ray ray(std::uint32_t i) const;
///     void store(std::uint32_t i, const Hit& hit) const;
template <TriangleTest Test> class PersistentLane {
  public:
    using Walk = detail::CompressedWalk<Test, true>;
    using Stack = typename Walk::Stack;

    [[nodiscard]] RT_HD bool works() const { return works_; }

    /// Stores the hit of the ray before and takes ray i, or none if there are not as many.
    template <class Items>
    RT_HD void refill(const CompressedView& view, const Items& items, std::uint32_t i) {
        store(items);
        item_ = i;
        if (i >= items.count())
            return;
        const Ray ray = items.ray(i);
        hit_ = {};
        works_ = is_valid(ray);
        if (works_) {
            hit_.t = ray.tmax;
            walk_ = Walk(view, ray);
        }
    }
    /// Once a ray: by the next refill, or at the end.
    template <class Items> RT_HD void store(const Items& items) {
        if (item_ >= items.count())
            return;
        if (!hit_.valid())
            hit_.t = infinity;
        items.store(item_, hit_);
    }
    /// One turn of a lane that works.
    RT_HD void turn(const CompressedView& view, Stack& stack) {
        NoTally tally;
        works_ = walk_.turn(view, stack, hit_.t, tally,
                            [this](const PrimitiveHit& hit, const CompressedPrimitive& p) {
                                detail::keep_closer(hit, p.geometry, p.primitive, hit_);
                                return false;
                            });
    }

  private:
    Walk walk_{{}, Ray{{}, 0, {1, 1, 1}, 0}}; ///< none yet
    Hit hit_;
    std::uint32_t item_ = invalid_id; ///< whose hit is to be stored
    bool works_ = false;
};

/// What a warp does: closest hits until no rays are left. `Warp` has
///     void each(f);             // calls f(lane, stack, number) for each lane that it has here
///     std::uint32_t vote(f);    // bit i: f(lane i)
///     std::uint32_t take(std::uint32_t& counter, std::uint32_t n);   // for the warp; the old
///     value
template <class Warp, class Items>
RT_HD void trace_persistently(Warp&& warp, const CompressedView& view, const Items& items,
                              std::uint32_t& taken) {
    for (bool left = true;;) { // the same in all lanes, as all that is decided by votes
        const std::uint32_t idle = warp.vote([](const auto& lane) { return !lane.works(); });
        if (left && ones(idle) >= refill_from) {
            const std::uint32_t first = warp.take(taken, ones(idle));
            left = first + ones(idle) < items.count();
            warp.each([&](auto& lane, auto& /*stack*/, std::uint32_t number) {
                if ((idle >> number & 1u) != 0)
                    lane.refill(view, items, first + ones(idle & ((1u << number) - 1)));
            });
        } else if (idle == 0xffffffffu) {
            break;
        }
        warp.each([&](auto& lane, auto& stack, std::uint32_t /*number*/) {
            if (lane.works())
                lane.turn(view, stack);
        });
    }
    warp.each([&](auto& lane, auto& /*stack*/, std::uint32_t /*number*/) { lane.store(items); });
}

} // namespace plumb
