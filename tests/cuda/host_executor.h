/// \file  Renders by the GPU's own steps on the host: placed copies, batches, grids of threads.
#pragma once

#include "cuda/place_scene.h"
#include "cuda/render_batches.h"

#include <cstring>
#include <memory>
#include <new>

namespace plumb::test {

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

/// An executor of BatchRenderer. `block_size`: threads in a block.
template <Features F, TriangleTest Test> class HostExecutor {
  public:
    HostExecutor(const DeviceJob& device, std::uint32_t block_size)
        : device_(device), block_size_(block_size) {}

    void clear(std::uint32_t pixels) {
        film_.assign(pixels, {});
        counts_ = {};
        device_.film = film_.data();
        device_.counts = &counts_;
    }
    RayCounts run(const Batch& batch) {
        ++launches_;
        device_.batch = batch;
        run_grid_on_host(shape_for(batch.pixel_count, block_size_),
                         [&](GridPosition at) { render_thread<F, Test>(device_, at); });
        return counts_;
    }
    void fetch(std::span<FilmPixel> film) const {
        std::copy_n(film_.begin(), film.size(), film.begin());
    }
    [[nodiscard]] int launches() const { return launches_; }

  private:
    DeviceJob device_;
    std::uint32_t block_size_;
    std::vector<FilmPixel> film_;
    RayCounts counts_;
    int launches_ = 0;
};

/// Bytes that a job and its tree take.
[[nodiscard]] inline std::size_t placed_size(const RenderJob& job, const SahView& tree) {
    Arena measure;
    static_cast<void>(place(job.scene, measure));
    static_cast<void>(place(tree, measure));
    return measure.used();
}

} // namespace plumb::test
