/// \file  The warp of persistent threads on a device.
#pragma once

#include "cuda/launch.cuh"
#include "cuda/persistent.h"

namespace plumb {
namespace {

/// The Warp of trace_persistently, seen from one lane: all 32 must make each call.
template <TriangleTest Test> class DeviceWarp {
  public:
    using Lane = PersistentLane<Test>;

    RT_HD DeviceWarp(Lane& lane, typename Lane::Stack& stack) : lane_(lane), stack_(stack) {}

#ifdef __CUDA_ARCH__
    template <class F> RT_HD void each(F&& f) const { f(lane_, stack_, number()); }
    template <class F> [[nodiscard]] RT_HD std::uint32_t vote(F&& f) const {
        return __ballot_sync(0xffffffffu, f(lane_));
    }
    [[nodiscard]] RT_HD std::uint32_t take(std::uint32_t& counter, std::uint32_t n) const {
        std::uint32_t first = 0;
        if (number() == 0)
            first = atomicAdd(&counter, n);
        return __shfl_sync(0xffffffffu, first, 0);
    }

  private:
    [[nodiscard]] RT_HD static std::uint32_t number() { return threadIdx.x % warp_lanes; }
#else // never called: a kernel has no body on the host
    template <class F> RT_HD void each(F&&) const {}
    template <class F> [[nodiscard]] RT_HD std::uint32_t vote(F&&) const { return 0; }
    [[nodiscard]] RT_HD std::uint32_t take(std::uint32_t&, std::uint32_t) const { return 0; }

  private:
#endif
    Lane& lane_;
    typename Lane::Stack& stack_;
};

template <TriangleTest Test, class Items>
__device__ void trace_persistently_on_device(const CompressedView& view, const Items& items,
                                             std::uint32_t& taken) {
    PersistentLane<Test> lane;
    typename PersistentLane<Test>::Stack stack; // apart: a struct with it would be kept in memory
    trace_persistently(DeviceWarp<Test>(lane, stack), view, items, taken);
}

/// As many threads as the current device holds at a time, `items` at most.
inline LaunchShape persistent_shape(const void* kernel, std::uint64_t items) {
    int device = 0, multiprocessors = 0, blocks = 0;
    RT_CUDA_CHECK(cudaGetDevice(&device));
    RT_CUDA_CHECK(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device));
    RT_CUDA_CHECK(cudaOccupancyMaxActiveBlocksPerMultiprocessor(
        &blocks, kernel, static_cast<int>(threads_per_block), 0));
    LaunchShape shape = shape_for(items, threads_per_block);
    shape.blocks = std::min(shape.blocks, static_cast<std::uint32_t>(multiprocessors * blocks));
    return shape;
}

} // namespace
} // namespace plumb
