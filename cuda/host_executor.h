/// \file  Renders by the GPU's own steps on the host: placed copies, batches, grids of threads.
#pragma once

#include "cuda/host_warp.h"
#include "cuda/place_scene.h"
#include "cuda/render_batches.h"
#include "cuda/wave_runner.h"

#include <cstring>
#include <memory>
#include <new>
#include <numeric>

namespace plumb {

/// A block of host memory in place of the device's.
class HostBlock {
  public:
    explicit HostBlock(std::size_t bytes)
        : bytes_(bytes), block_(static_cast<std::byte*>(
                             ::operator new (bytes + 1, std::align_val_t{Arena::alignment}))) {}

    [[nodiscard]] Arena arena() {
        return {block_.get(), [](std::byte* to, const void* from, std::size_t bytes) {
                    std::memcpy(to, from, bytes);
                }};
    }
    /// Whether all of an array lies in the block; empty arrays do.
    [[nodiscard]] bool holds(const void* data, std::size_t bytes) const {
        const auto* at = static_cast<const std::byte*>(data);
        return bytes == 0 || (at >= block_.get() && at + bytes <= block_.get() + bytes_);
    }
    template <class T> [[nodiscard]] bool holds(std::span<const T> array) const {
        return holds(array.data(), array.size_bytes());
    }

  private:
    struct Free {
        void operator()(std::byte* block) const {
            ::operator delete (block, std::align_val_t{Arena::alignment});
        }
    };
    std::size_t bytes_;
    std::unique_ptr<std::byte, Free> block_;
};

/// How the host runs a grid.
struct HostGrid {
    std::uint32_t block_size = 128;
    std::uint32_t chunk_pixels = 1u << 14;
    std::uint32_t wave_slots = 1u << 14; ///< paths at a time, if that is all pixels of a chunk
    std::uint32_t shuffle = 0; ///< 0: threads in order; else in another order for each number
};

/// Calls body(GridPosition) for every thread, in the order that the grid asks for.
template <class Body>
void run_grid_on_host(const HostGrid& grid, std::uint64_t items, Body&& body) {
    const LaunchShape shape = shape_for(items, grid.block_size);
    if (grid.shuffle == 0)
        return run_grid_on_host(shape, body);
    // Steps of a size without a common factor with the number of threads meet each of them once.
    const std::uint64_t threads = std::uint64_t{shape.blocks} * shape.block_size;
    std::uint64_t step =
        (2 * std::uint64_t{grid.shuffle} + 1) * 7919 % std::max(threads, std::uint64_t{1});
    while (std::gcd(step, threads) > 1)
        ++step;
    for (std::uint64_t i = 0, at = grid.shuffle % std::max(threads, std::uint64_t{1}); i < threads;
         ++i, at = (at + step) % threads)
        body(GridPosition{static_cast<std::uint32_t>(at / shape.block_size),
                          static_cast<std::uint32_t>(at % shape.block_size), shape.block_size});
}

/// As many as are asked for, and one for each pixel of a chunk at least.
[[nodiscard]] inline std::uint32_t slots_of(const HostGrid& grid, const DeviceJob& device) {
    const auto pixels = static_cast<std::uint32_t>(device.job.crop.width) *
                        static_cast<std::uint32_t>(device.job.crop.height);
    return std::max(grid.wave_slots, std::min(grid.chunk_pixels, pixels));
}

/// Film and counters of a chunk in host memory, and the job that writes them.
class HostFilm {
  public:
    explicit HostFilm(const DeviceJob& device) : device_(device) {}

    void clear(std::uint32_t pixels) {
        film_.assign(pixels, {});
        counts_ = {};
        device_.film = film_.data();
        device_.counts = &counts_;
    }
    void fetch(std::span<FilmPixel> film) const {
        std::copy_n(film_.begin(), film.size(), film.begin());
    }
    [[nodiscard]] int launches() const { return launches_; }

  protected:
    DeviceJob device_;
    RayCounts counts_;
    int launches_ = 0;

  private:
    std::vector<FilmPixel> film_;
};

/// The megakernel: an executor of BatchRenderer.
template <Features F, TriangleTest Test, CudaTree Tree> class HostExecutor : public HostFilm {
  public:
    HostExecutor(const DeviceJob& device, const HostGrid& grid)
        : HostFilm(device), grid_(grid), samples_(slots_of(grid, device)) {
        device_.samples = samples_.data();
    }

    RayCounts run(const Batch& batch) {
        in_waves(batch, static_cast<std::uint32_t>(samples_.size()), [&](const Batch& wave) {
            launches_ += 2;
            device_.batch = wave;
            run_grid_on_host(grid_, wave.slots(),
                             [&](GridPosition at) { render_thread<F, Test, Tree>(device_, at); });
            run_grid_on_host(grid_, wave.pixel_count,
                             [&](GridPosition at) { add_samples_thread(device_, at); });
        });
        return counts_;
    }

  private:
    HostGrid grid_;
    std::vector<Rgb> samples_;
};

/// The wavefront: another, and the launcher of its WaveRunner.
template <Features F, TriangleTest Test, CudaTree Tree> class HostWaves : public HostFilm {
  public:
    HostWaves(const DeviceJob& device, const HostGrid& grid, CudaSchedule schedule)
        : HostFilm(device), grid_(grid), schedule_(schedule), slots_(slots_of(grid, device)),
          paths_(slots_), hits_(slots_), now_(slots_), next_(slots_), shadows_(slots_) {}

    RayCounts run(const Batch& batch) {
        device_.batch = batch;
        const WaveView wave{paths_.data(), hits_.data(),    now_.data(),
                            next_.data(),  shadows_.data(), &counters_};
        counts_ += WaveRunner(*this, wave, slots_, schedule_).run(device_);
        return counts_;
    }
    void launch(WaveStage stage, const WaveJob& job) {
        ++launches_;
        if constexpr (Tree == CudaTree::wide)
            if (stage == WaveStage::extend_persistently)
                return trace_persistently_on_host<Test>(job.device.trees.wide, ExtendItems{job},
                                                        job.filled().taken);
        run_grid_on_host(grid_, job.threads, [&](GridPosition at) {
            switch (stage) {
            case WaveStage::generate: return generate_thread<F>(job, at);
            case WaveStage::extend_persistently: // of the wide tree only
            case WaveStage::extend: return extend_thread<Test, Tree>(job, at);
            case WaveStage::shade: return shade_thread<F>(job, at);
            case WaveStage::shadow: return shadow_thread<Test, Tree>(job, at);
            case WaveStage::accumulate: return accumulate_thread(job, at);
            }
        });
    }
    void clear_counters() { counters_ = {}; }
    [[nodiscard]] RunCounters counters() const { return counters_; }

  private:
    HostGrid grid_;
    CudaSchedule schedule_;
    std::uint32_t slots_;
    std::vector<PathState> paths_;
    std::vector<Hit> hits_;
    std::vector<std::uint32_t> now_, next_;
    std::vector<ShadowEntry> shadows_;
    RunCounters counters_{};
};

} // namespace plumb
