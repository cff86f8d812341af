/// \file  The kinds of rays of tools/bench through the model.
#pragma once

#include "tools/bench_src/ray_sets.h"
#include "tools/warp_src/order.h"

namespace plumb::warps {

/// What might be done about lanes that wait.
enum class RayWay : std::uint8_t {
    as_built,   ///< the kernels as they are
    together,   ///< the binary tree's loop without waiting at leaves
    sorted,     ///< rays sorted before the launch; the sorting itself costs nothing
    persistent, ///< warps take new rays when 20 lanes or fewer are at work
};
inline constexpr std::array<RayWay, 4> ray_ways{RayWay::as_built, RayWay::together, RayWay::sorted,
                                                RayWay::persistent};
[[nodiscard]] const char* name_of(RayWay way);

struct RayCell {
    bench::RayKind kind;
    CudaTree tree;
    RayWay way;
    Totals totals;         ///< of the multiprocessors looked at
    double rays_per_s = 0; ///< of the GPU
};

/// One cell. `rays` are all rays of the launch.
[[nodiscard]] RayCell model_cell(const TreeViews& trees, CudaTree tree, bench::RayKind kind,
                                 std::span<const Question> rays, RayWay way);

} // namespace plumb::warps
