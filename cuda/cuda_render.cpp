/// \file  The host side of the GPU renderer: memory, launches, errors.

#include "cuda/cuda_render.h"

#include "cuda/device_buffer.h"
#include "cuda/path_kernel.h"
#include "cuda/place_scene.h"
#include "cuda/render_batches.h"

namespace plumb {
namespace {

/// Pixels in work at a time: enough threads for any device, 60 MB of film.
constexpr std::uint32_t chunk_pixels = 1u << 20;

/// Makes the first device current. Throws DeviceError if it cannot run the kernels.
void start_device() {
    int driver = 0;
    if (cudaDriverGetVersion(&driver) == cudaSuccess && driver == 0)
        throw DeviceError("cuda: there is no NVIDIA driver");
    RT_CUDA_CHECK(cudaSetDevice(0));
    check_path_kernel();
}

/// The job and its tree in one block of device memory.
class PlacedJob {
  public:
    PlacedJob(const RenderJob& job, const SahView& tree) : block_(size_of(job, tree)) {
        Arena arena(block_.data(), [](std::byte* to, const void* from, std::size_t bytes) {
            RT_CUDA_CHECK(cudaMemcpy(to, from, bytes, cudaMemcpyHostToDevice));
        });
        device_.job = job;
        device_.job.scene = place(job.scene, arena);
        device_.tree = place(tree, arena);
    }

    [[nodiscard]] const DeviceJob& device() const { return device_; }

  private:
    static std::size_t size_of(const RenderJob& job, const SahView& tree) {
        Arena measure;
        static_cast<void>(place(job.scene, measure));
        static_cast<void>(place(tree, measure));
        return measure.used();
    }

    DeviceBuffer<std::byte> block_;
    DeviceJob device_;
};

/// Runs batches on the device: an executor of BatchRenderer.
class DeviceExecutor {
  public:
    DeviceExecutor(const DeviceJob& device, PathKernel kernel, std::size_t pixels)
        : device_(device), kernel_(kernel), film_(pixels), counts_(1) {
        device_.film = film_.data();
        device_.counts = counts_.data();
    }

    void clear(std::uint32_t pixels) { // an empty FilmPixel is all zero bits
        film_.clear(pixels);
        counts_.clear(1);
    }
    RayCounts run(const Batch& batch) {
        device_.batch = batch;
        launch_path_kernel(device_, kernel_);
        RT_CUDA_CHECK(cudaDeviceSynchronize());
        RayCounts counts;
        counts_.copy_to({&counts, 1});
        return counts;
    }
    void fetch(std::span<FilmPixel> film) const { film_.copy_to(film); }

  private:
    DeviceJob device_;
    PathKernel kernel_;
    DeviceBuffer<FilmPixel> film_;
    DeviceBuffer<RayCounts> counts_;
};

} // namespace

bool cuda_available(std::string* why) {
    try {
        start_device();
        return true;
    } catch (const DeviceError& error) {
        if (why != nullptr)
            *why = error.what();
        return false;
    }
}

Film render_on_cuda(const RenderJob& job, const Features& needed, const SahView& tree,
                    TriangleTest test, const RenderOptions& options, RenderStats& stats) {
    start_device();
    const bool box = box_profile.covers(needed) && !options.force_full_profile &&
                     test == TriangleTest::watertight;
    stats.profile = profile_name(box ? box_profile : full_profile);
    const PathKernel kernel = box ? PathKernel::box
                              : test == TriangleTest::watertight
                                  ? PathKernel::full
                                  : PathKernel::full_moeller_trumbore;
    const PlacedJob placed(job, tree);
    DeviceJob device = placed.device();
    device.with_variance = options.variance;
    const auto pixels =
        static_cast<std::uint64_t>(job.crop.width) * static_cast<std::uint64_t>(job.crop.height);
    const auto chunk = static_cast<std::uint32_t>(std::min<std::uint64_t>(chunk_pixels, pixels));
    DeviceExecutor executor(device, kernel, chunk);
    return BatchRenderer(job, options, executor, stats).render(chunk);
}

} // namespace plumb
