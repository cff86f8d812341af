/// \file  Which tree a device traverses and how its kernels are scheduled.
#pragma once

#include "accel/sah/compressed_traverse.h"

#include <string_view>

namespace plumb {

/// binary: the SAH tree of SahView. wide: the compressed 8-wide tree. The same bits.
enum class CudaTree : std::uint8_t { binary, wide };

/// megakernel: a thread takes a pixel's samples from camera to end. wavefront: a kernel a step,
/// over all paths. The same bits.
enum class CudaSchedule : std::uint8_t { megakernel, wavefront };

/// The defaults are what the model of an H100 makes fastest (README).
struct CudaSettings {
    CudaTree tree = CudaTree::wide;
    CudaSchedule schedule = CudaSchedule::wavefront;
};

[[nodiscard]] constexpr std::string_view name_of(CudaTree tree) {
    return tree == CudaTree::binary ? "binary" : "wide";
}
[[nodiscard]] constexpr std::string_view name_of(CudaSchedule schedule) {
    return schedule == CudaSchedule::megakernel ? "megakernel" : "wavefront";
}

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
