/// \file  What one GPU thread of the megakernel does: a whole sample, host and device.
///
/// The very camera, path, traversal and FilmPixel::add of the CPU, in the same order for each
/// pixel: the film is the same bits by construction.
#pragma once

#include "cuda/device_tree.h"
#include "cuda/waves.h"

namespace plumb {

/// The kernels that are compiled. The Möller-Trumbore test is there for comparison: no kernel of
/// its own for simple scenes.
enum class PathKernel : std::uint8_t { box, full, full_moeller_trumbore };

[[nodiscard]] inline PathKernel path_kernel_for(const Features& needed, TriangleTest test,
                                                bool force_full) {
    if (test == TriangleTest::moeller_trumbore)
        return PathKernel::full_moeller_trumbore;
    return box_profile.covers(needed) && !force_full ? PathKernel::box : PathKernel::full;
}

/// What a kernel is launched with. Every pointer and span is of the side that runs it.
struct DeviceJob {
    RenderJob job;
    /// job.filter, which every lane reads elsewhere, in memory made for that: among a kernel's
    /// parameters lanes that read different words take turns.
    const FilterTable* filter = nullptr;
    TreeViews trees;
    Batch batch;
    FilmPixel* film = nullptr;   ///< batch.pixel_count, so far
    Rgb* samples = nullptr;      ///< by slot, weighted; of the megakernel
    RayCounts* counts = nullptr; ///< one, for all threads
    bool with_variance = false;
};

namespace detail {

/// Adds to a counter that all threads share. Integers: any order gives the same sum.
RT_HD inline void add_shared(std::uint64_t& counter, std::uint64_t n) {
#ifdef __CUDA_ARCH__
    static_assert(sizeof(unsigned long long) == sizeof(std::uint64_t));
    auto* const shared = reinterpret_cast<unsigned long long*>(&counter);
#if __CUDA_ARCH__ >= 800
    // One addition for all lanes that are here: a path has fewer than 2^27 rays.
    const unsigned here = __activemask();
    const unsigned sum = __reduce_add_sync(here, static_cast<unsigned>(n));
    if (threadIdx.x % 32 == static_cast<unsigned>(__ffs(static_cast<int>(here)) - 1))
        atomicAdd(shared, sum);
#else
    atomicAdd(shared, n);
#endif
#else
    counter += n;
#endif
}

} // namespace detail

/// Item i: the sample of slot i.
template <Features F, TriangleTest Test, CudaTree Tree>
RT_HD void render_thread(const DeviceJob& device, GridPosition at) {
    if (at.index() >= device.batch.slots())
        return;
    const SlotSample sample(device.job.crop, device.batch, static_cast<std::uint32_t>(at.index()));
    const Sampler sampler = sample.sampler(device.job);
    const CameraSample camera = sample.camera(device.job, *device.filter, sampler);
    const TreeQuery<Test, Tree> query{device.trees};
    const PathSteps<F> steps(device.job.scene, device.job.path);
    RayCounts counts;
    device.samples[at.index()] =
        trace_path(steps, query, camera.ray, sampler, counts) * camera.weight;
    detail::add_shared(device.counts->camera, counts.camera);
    detail::add_shared(device.counts->bounce, counts.bounce);
    detail::add_shared(device.counts->shadow, counts.shadow);
}

/// Item i: adds the samples of pixel i of the batch.
RT_HD inline void add_samples_thread(const DeviceJob& device, GridPosition at) {
    add_samples(device.batch, device.film, device.with_variance, at,
                [&](std::uint64_t slot) { return device.samples[slot]; });
}

} // namespace plumb
