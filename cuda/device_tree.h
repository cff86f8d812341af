/// \file  Which tree a device traverses and how its kernels are scheduled.
#pragma once

#include "accel/sah/compressed_traverse.h"

#include <string_view>

namespace plumb {

/// binary: the SAH tree of SahView. wide: the compressed 8-wide tree. The same bits.
enum class CudaTree : std::uint8_t { binary, wide };

/// megakernel: a thread takes a sample from camera to end. wavefront: a kernel a step, over all
/// paths. persistent: likewise, and from the second depth on persistent threads trace the rays;
/// needs the wide tree. The same bits.
enum class CudaSchedule : std::uint8_t { megakernel, wavefront, persistent };

/// A thread for each ray, or persistent threads (persistent.h): closest hits in the wide tree only.
enum class RayThreads : std::uint8_t { one_a_ray, persistent };

/// The defaults are what the model of an H100 makes fastest (README).
struct CudaSettings {
    CudaTree tree = CudaTree::wide;
    CudaSchedule schedule = CudaSchedule::wavefront;
};

[[nodiscard]] constexpr std::string_view name_of(CudaTree tree) {
    return tree == CudaTree::binary ? "binary" : "wide";
}
[[nodiscard]] constexpr std::string_view name_of(CudaSchedule schedule) {
    switch (schedule) {
    case CudaSchedule::megakernel: return "megakernel";
    case CudaSchedule::wavefront: return "wavefront";
    case CudaSchedule::persistent: return "persistent";
    }
    return {};
}
[[nodiscard]] constexpr std::string_view name_of(RayThreads threads) {
    return threads == RayThreads::one_a_ray ? "one a ray" : "persistent";
}

/// Every combination that there is.
inline constexpr CudaSettings all_cuda_settings[] = {{CudaTree::binary, CudaSchedule::megakernel},
                                                     {CudaTree::wide, CudaSchedule::megakernel},
                                                     {CudaTree::binary, CudaSchedule::wavefront},
                                                     {CudaTree::wide, CudaSchedule::wavefront},
                                                     {CudaTree::wide, CudaSchedule::persistent}};

/// The tree of a scene; the other one is empty.
struct TreeViews {
    SahView binary;
    CompressedView wide;
};

/// Ray queries of a kernel.
template <TriangleTest Test, CudaTree Tree> struct TreeQuery {
    const TreeViews& trees;

    [[nodiscard]] RT_HD Hit closest(const Ray& ray) const {
        if constexpr (Tree == CudaTree::binary)
            return plumb::closest<Test>(trees.binary, ray);
        else
            return plumb::closest<Test>(trees.wide, ray);
    }
    [[nodiscard]] RT_HD bool occluded(const Ray& ray) const {
        if constexpr (Tree == CudaTree::binary)
            return plumb::occluded<Test>(trees.binary, ray);
        else
            return plumb::occluded<Test>(trees.wide, ray);
    }
};

} // namespace plumb
