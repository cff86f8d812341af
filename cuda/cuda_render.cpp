/// \file  The host side of the GPU renderer: memory and the executors that launch.

#include "cuda/cuda_render.h"

#include "cuda/device.h"
#include "cuda/device_buffer.h"
#include "cuda/path_kernel.h"
#include "cuda/place_scene.h"
#include "cuda/render_batches.h"

#include <chrono>

namespace plumb {
namespace {

/// Pixels in work at a time: enough threads for any device, 60 MB of film.
constexpr std::uint32_t chunk_pixels = 1u << 20;

/// Paths in work at a time: 12 bytes each in the megakernel, 250 in a wavefront.
constexpr std::uint32_t wave_slots = 1u << 20;

/// Launched at first: fills a device, and takes less than a second if paths are slow.
constexpr std::uint32_t first_paths = 1u << 18;

/// Slots for a chunk of so many pixels.
std::uint32_t slots_for(std::size_t pixels) {
    return std::max(wave_slots, static_cast<std::uint32_t>(pixels));
}

/// The job and its tree in one block of device memory.
class PlacedJob {
  public:
    PlacedJob(const RenderJob& job, const TreeViews& trees) : block_(size_of(job, trees)) {
        Arena arena(block_.data(), [](std::byte* to, const void* from, std::size_t bytes) {
            RT_CUDA_CHECK(cudaMemcpy(to, from, bytes, cudaMemcpyHostToDevice));
        });
        device_ = place(job, trees, arena);
    }

    [[nodiscard]] const DeviceJob& device() const { return device_; }
    [[nodiscard]] std::size_t bytes() const { return block_.size(); }

  private:
    static std::size_t size_of(const RenderJob& job, const TreeViews& trees) {
        const std::size_t bytes = placed_size(job, trees);
        require_device_memory(bytes, "the scene");
        return bytes;
    }

    DeviceBuffer<std::byte> block_;
    DeviceJob device_;
};

/// Film and counters of a chunk.
class DeviceFilm {
  public:
    DeviceFilm(const DeviceJob& device, PathKernel kernel, const CudaSettings& settings,
               std::size_t pixels)
        : device_(device), kernel_(kernel), settings_(settings), film_(pixels), counts_(1) {
        device_.film = film_.data();
        device_.counts = counts_.data();
    }

    void clear(std::uint32_t pixels) { // an empty FilmPixel is all zero bits
        film_.clear(pixels);
        counts_.clear(1);
    }
    void fetch(std::span<FilmPixel> film) const { film_.copy_to(film); }

  protected:
    DeviceJob device_;
    PathKernel kernel_;
    CudaSettings settings_;
    DeviceBuffer<FilmPixel> film_;
    DeviceBuffer<RayCounts> counts_;
};

/// Runs batches by the megakernel: an executor of BatchRenderer.
class DeviceExecutor : public DeviceFilm {
  public:
    DeviceExecutor(const DeviceJob& device, PathKernel kernel, const CudaSettings& settings,
                   std::size_t pixels)
        : DeviceFilm(device, kernel, settings, pixels), samples_(slots_for(pixels)) {
        device_.samples = samples_.data();
    }

    RayCounts run(const Batch& batch) {
        in_waves(batch, static_cast<std::uint32_t>(samples_.size()), [&](const Batch& wave) {
            device_.batch = wave;
            launch_path_kernel(device_, kernel_, settings_.tree);
        });
        RT_CUDA_CHECK(cudaDeviceSynchronize());
        RayCounts counts;
        counts_.copy_to({&counts, 1});
        return counts;
    }
    [[nodiscard]] std::size_t bytes() const {
        return film_.size() * sizeof(FilmPixel) + samples_.size() * sizeof(Rgb);
    }
    [[nodiscard]] std::vector<KernelReport> kernels() const {
        return path_kernel_reports(kernel_, settings_.tree);
    }

  private:
    DeviceBuffer<Rgb> samples_;
};

/// Runs batches by the wavefront: another, and the launcher of its WaveRunner.
class DeviceWaves : public DeviceFilm {
  public:
    DeviceWaves(const DeviceJob& device, PathKernel kernel, const CudaSettings& settings,
                std::size_t pixels)
        : DeviceFilm(device, kernel, settings, pixels), slots_(slots_for(pixels)), paths_(slots_),
          hits_(slots_), now_(slots_), next_(slots_), shadows_(slots_), counters_(1) {}

    void clear(std::uint32_t pixels) {
        DeviceFilm::clear(pixels);
        rays_ = {};
    }
    RayCounts run(const Batch& batch) {
        device_.batch = batch;
        const WaveView wave{paths_.data(), hits_.data(),    now_.data(),
                            next_.data(),  shadows_.data(), counters_.data()};
        rays_ += WaveRunner(*this, wave, slots_, settings_.schedule).run(device_);
        RT_CUDA_CHECK(cudaDeviceSynchronize());
        return rays_;
    }
    void launch(WaveStage stage, const WaveJob& job) {
        launch_wave_stage(stage, job, kernel_, settings_.tree);
    }
    void clear_counters() { counters_.clear(1); }
    [[nodiscard]] RunCounters counters() const {
        RunCounters counters;
        counters_.copy_to({&counters, 1});
        return counters;
    }
    [[nodiscard]] std::size_t bytes() const {
        return film_.size() * sizeof(FilmPixel) +
               slots_ * (sizeof(PathState) + sizeof(Hit) + 2 * sizeof(std::uint32_t) +
                         sizeof(ShadowEntry));
    }
    [[nodiscard]] std::vector<KernelReport> kernels() const {
        return wave_kernel_reports(kernel_, settings_);
    }

  private:
    std::uint32_t slots_;
    DeviceBuffer<PathState> paths_;
    DeviceBuffer<Hit> hits_;
    DeviceBuffer<std::uint32_t> now_, next_;
    DeviceBuffer<ShadowEntry> shadows_;
    DeviceBuffer<RunCounters> counters_;
    RayCounts rays_;
};

struct Work {
    const RenderJob& job;
    const DeviceJob& device;
    PathKernel kernel;
    const CudaSettings& settings;
    const RenderOptions& options;
    RenderStats& stats;
    DeviceReport& report;

    template <class Executor> [[nodiscard]] Film run() const {
        const auto pixels = static_cast<std::uint64_t>(job.crop.width) *
                            static_cast<std::uint64_t>(job.crop.height);
        const auto chunk =
            static_cast<std::uint32_t>(std::min<std::uint64_t>(chunk_pixels, pixels));
        Executor executor(device, kernel, settings, chunk);
        report.working_bytes = executor.bytes();
        report.kernels = executor.kernels();
        return BatchRenderer(job, options, executor, stats, first_paths).render(chunk);
    }
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

std::string cuda_device_name() {
    start_device();
    return device_name();
}

Film render_on_cuda(const RenderJob& job, const Features& needed, const TreeViews& trees,
                    TriangleTest test, const CudaSettings& settings, const RenderOptions& options,
                    RenderStats& stats, DeviceReport* report) {
    start_device();
    DeviceReport unread;
    DeviceReport& told = report != nullptr ? *report : unread;
    told.device = device_name();
    const PathKernel kernel = path_kernel_for(needed, test, options.force_full_profile);
    stats.profile = profile_name(kernel == PathKernel::box ? box_profile : full_profile);
    const auto start = std::chrono::steady_clock::now();
    const PlacedJob placed(job, trees);
    told.upload_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    told.scene_bytes = placed.bytes();
    DeviceJob device = placed.device();
    device.with_variance = options.variance;
    const Work work{job, device, kernel, settings, options, stats, told};
    return settings.schedule == CudaSchedule::megakernel ? work.run<DeviceExecutor>()
                                                         : work.run<DeviceWaves>();
}

} // namespace plumb
