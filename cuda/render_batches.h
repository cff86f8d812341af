/// \file  The order of launches: short ones, so that a render can be watched and stopped.
///
/// Chunks of pixels one after the other, each over growing ranges of samples. A pixel's samples are
/// added in order whatever the cuts, so they change no bit. Knows no device: tests run it on the
/// host.
#pragma once

#include "cuda/render_kernel.h"
#include "renderer/integrate/render.h"

#include <algorithm>
#include <chrono>
#include <span>
#include <vector>

namespace plumb {

/// How many samples of each pixel the next launch takes, from how long the last one took.
class SampleStep {
  public:
    /// `first`: of the first launch, 1 or more.
    explicit SampleStep(std::uint32_t first) : value_(first) {}

    [[nodiscard]] std::uint32_t value() const { return value_; }

    void measured(double seconds) {
        if (seconds < shortest_s)
            value_ = std::min(2 * value_, 1u << 16);
        else if (seconds > longest_s)
            value_ = std::max(value_ / 2, 1u);
    }

  private:
    static constexpr double shortest_s = 0.05, longest_s = 0.2; ///< of a launch
    std::uint32_t value_;
};

namespace detail {

/// Puts the pixels of a batch where they belong.
inline void store(std::span<const FilmPixel> pixels, const Batch& batch, Film& film) {
    const Crop& crop = film.crop();
    const auto width = static_cast<std::uint64_t>(crop.width);
    for (std::uint64_t i = 0; i < pixels.size(); ++i) {
        const std::uint64_t pixel = batch.first_pixel + i;
        film.pixel(crop.x + static_cast<int>(pixel % width),
                   crop.y + static_cast<int>(pixel / width)) = pixels[i];
    }
}

} // namespace detail

/// Renders by launches on `executor`, which has
///     void clear(std::uint32_t pixels);        // empties the film of a chunk, and the counters
///     RayCounts run(const Batch& batch);       // returns when done, with the rays since clear()
///     void fetch(std::span<FilmPixel> film);   // the film of the chunk
/// Cancelled: the pixels of the chunk in work have fewer samples, those behind it none. Sets
/// stats.rays, samples, stopped_by and render_s.
template <class Executor> class BatchRenderer {
  public:
    /// `first_paths`: about so many are launched at first.
    BatchRenderer(const RenderJob& job, const RenderOptions& options, Executor& executor,
                  RenderStats& stats, std::uint32_t first_paths = 1)
        : job_(job), options_(options), executor_(executor), stats_(stats),
          pixels_(static_cast<std::uint64_t>(job.crop.width) *
                  static_cast<std::uint64_t>(job.crop.height)),
          step_(std::max(1u, first_paths / static_cast<std::uint32_t>(std::clamp<std::uint64_t>(
                                               pixels_, 1, first_paths)))) {}

    [[nodiscard]] Film render(std::uint32_t chunk_pixels) {
        const Crop& crop = job_.crop;
        const auto start = Clock::now();
        Film film(job_.width, job_.height, crop, options_.variance);
        std::vector<FilmPixel> chunk;
        Batch batch;
        for (; batch.first_pixel < pixels_ && !cancelled();
             batch.first_pixel += batch.pixel_count) {
            const std::uint64_t rest = pixels_ - batch.first_pixel;
            batch.pixel_count =
                static_cast<std::uint32_t>(std::min<std::uint64_t>(chunk_pixels, rest));
            render_chunk(batch);
            chunk.resize(batch.pixel_count);
            executor_.fetch(chunk);
            detail::store(chunk, batch, film);
        }
        stats_.stopped_by = cancelled() ? StoppedBy::signal : StoppedBy::spp;
        stats_.render_s = seconds_since(start);
        return film;
    }

  private:
    using Clock = std::chrono::steady_clock;

    static double seconds_since(Clock::time_point start) {
        return std::chrono::duration<double>(Clock::now() - start).count();
    }
    [[nodiscard]] bool cancelled() const {
        return options_.cancel != nullptr && options_.cancel->load(std::memory_order_relaxed);
    }

    void render_chunk(Batch batch) {
        const std::uint32_t spp = job_.sampler.spp;
        const RayCounts before = stats_.rays;
        executor_.clear(batch.pixel_count);
        while (batch.end_sample < spp && !cancelled()) {
            batch.first_sample = batch.end_sample;
            batch.end_sample += std::min(step_.value(), spp - batch.end_sample);
            const auto start = Clock::now();
            const RayCounts counts = executor_.run(batch);
            step_.measured(seconds_since(start));
            stats_.rays = before;
            stats_.rays += counts;
            stats_.samples +=
                std::uint64_t{batch.pixel_count} * (batch.end_sample - batch.first_sample);
            if (options_.progress)
                options_.progress({static_cast<double>(stats_.samples) /
                                       (static_cast<double>(pixels_) * static_cast<double>(spp)),
                                   stats_.rays.total()});
        }
    }

    const RenderJob& job_;
    const RenderOptions& options_;
    Executor& executor_;
    RenderStats& stats_;
    std::uint64_t pixels_; ///< of the crop
    SampleStep step_;
};

} // namespace plumb
