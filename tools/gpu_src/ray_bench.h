/// \file  Times the five kinds of rays of tools/bench on both trees, and compares every hit.
#pragma once

#include "tools/bench_src/ray_sets.h"
#include "tools/gpu_src/options.h"

namespace plumb::gpu {

/// One kind of rays on one tree.
struct RayCell {
    bench::RayKind kind = bench::RayKind::primary;
    std::size_t rays = 0;
    std::uint64_t wrong = 0;          ///< hits that are not the CPU's, bit for bit
    double mrays_s = 0;               ///< median
    double nodes = 0, primitives = 0; ///< touched by a ray
    std::vector<KernelReport> kernels;
};

struct RayResult {
    std::string mesh;
    std::size_t triangles = 0;
    CudaTree tree = CudaTree::binary;
    RayThreads threads = RayThreads::one_a_ray;
    double build_s = 0, upload_s = 0;
    std::size_t bytes = 0;
    std::vector<RayCell> cells;
};

/// Prints a line for each cell as it comes and appends each tree of each mesh to `results`. Throws
/// DeviceError.
void bench_rays(const Options& options, std::vector<RayResult>& results);

[[nodiscard]] std::string to_json(const RayResult& result);

} // namespace plumb::gpu
