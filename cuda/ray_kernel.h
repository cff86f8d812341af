/// \file  What one GPU thread does with a batch of rays: one query; host and device.
#pragma once

#include "cuda/device_tree.h"
#include "cuda/grid.h"
#include "cuda/persistent.h"

namespace plumb {

/// What the kernel is launched with. Every pointer is of the side that runs it.
struct RayJob {
    TreeViews trees;
    const Ray* rays = nullptr;
    std::uint64_t count = 0;
    Hit* hits = nullptr;            ///< of closest queries
    std::uint8_t* found = nullptr;  ///< of any-hit queries: 1 or 0
    std::uint32_t* taken = nullptr; ///< by persistent threads: 0 before a launch
};

/// All rays of a job, fewer than 2^31, for persistent threads.
struct RayItems {
    const RayJob& job;

    [[nodiscard]] RT_HD std::uint32_t count() const {
        return static_cast<std::uint32_t>(job.count);
    }
    [[nodiscard]] RT_HD Ray ray(std::uint32_t i) const { return job.rays[i]; }
    RT_HD void store(std::uint32_t i, const Hit& hit) const { job.hits[i] = hit; }
};

/// Item i: ray i.
template <TriangleTest Test, CudaTree Tree, bool AnyHit>
RT_HD void trace_ray_thread(const RayJob& job, GridPosition at) {
    const std::uint64_t i = at.index();
    if (i >= job.count)
        return;
    const TreeQuery<Test, Tree> query{job.trees};
    const Ray ray = job.rays[i];
    if constexpr (AnyHit)
        job.found[i] = query.occluded(ray) ? 1 : 0;
    else
        job.hits[i] = query.closest(ray);
}

} // namespace plumb
