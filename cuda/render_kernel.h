/// \file  What one GPU thread does: the samples of one pixel, in order, host and device.
///
/// The very sample_pixel, traversal and FilmPixel::add of the CPU, in the same order for each
/// pixel: the film is the same bits by construction.
#pragma once

#include "cuda/device_tree.h"
#include "cuda/grid.h"
#include "renderer/integrate/film.h"
#include "renderer/integrate/pixel.h"

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

/// The work of one launch. Pixels of the crop are numbered row by row from 0.
struct Batch {
    std::uint64_t first_pixel = 0;
    std::uint32_t pixel_count = 0;
    std::uint32_t first_sample = 0, end_sample = 0; ///< of each pixel
};

/// What a kernel is launched with. Every pointer and span is of the side that runs it.
struct DeviceJob {
    RenderJob job;
    TreeViews trees;
    Batch batch;
    FilmPixel* film = nullptr;   ///< batch.pixel_count, so far
    RayCounts* counts = nullptr; ///< one, for all threads
    bool with_variance = false;
};

namespace detail {

/// Adds to a counter that all threads share. Integers: any order gives the same sum.
RT_HD inline void add_shared(std::uint64_t& counter, std::uint64_t n) {
#ifdef __CUDA_ARCH__
    static_assert(sizeof(unsigned long long) == sizeof(std::uint64_t));
    atomicAdd(reinterpret_cast<unsigned long long*>(&counter), n);
#else
    counter += n;
#endif
}

} // namespace detail

/// The body of the kernel: thread i renders pixel i of the batch.
template <Features F, TriangleTest Test, CudaTree Tree>
RT_HD void render_thread(const DeviceJob& device, GridPosition at) {
    const std::uint64_t i = at.index();
    if (i >= device.batch.pixel_count)
        return;
    const Crop& crop = device.job.crop;
    const std::uint64_t pixel = device.batch.first_pixel + i;
    const auto width = static_cast<std::uint64_t>(crop.width);
    const int x = crop.x + static_cast<int>(pixel % width);
    const int y = crop.y + static_cast<int>(pixel / width);
    const TreeQuery<Test, Tree> query{device.trees};
    FilmPixel sum = device.film[i];
    RayCounts counts;
    for (std::uint32_t s = device.batch.first_sample; s < device.batch.end_sample; ++s)
        sum.add(sample_pixel<F>(device.job, query, x, y, s, counts), device.with_variance);
    device.film[i] = sum;
    detail::add_shared(device.counts->camera, counts.camera);
    detail::add_shared(device.counts->bounce, counts.bounce);
    detail::add_shared(device.counts->shadow, counts.shadow);
}

} // namespace plumb
