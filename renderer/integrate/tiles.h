/// \file  Takes a range of samples of all or some pixels: tiles, threads, the choice of the kernel.
#pragma once

#include "accel/parallel/parallel.h"
#include "renderer/integrate/render.h"

#include <vector>

namespace plumb {

/// Samples [first, end) of a pixel.
struct SampleRange {
    std::uint32_t first, end;
};

/// Which pixels of a crop still get samples; at first all.
class PixelMask {
  public:
    explicit PixelMask(const Crop& crop)
        : crop_(crop),
          count_(static_cast<std::size_t>(crop.width) * static_cast<std::size_t>(crop.height)),
          holds_(count_, 1) {}

    /// (x, y) in the full film, inside the crop.
    [[nodiscard]] bool holds(int x, int y) const {
        return holds_[static_cast<std::size_t>(y - crop_.y) *
                          static_cast<std::size_t>(crop_.width) +
                      static_cast<std::size_t>(x - crop_.x)] != 0;
    }
    [[nodiscard]] std::size_t count() const { return count_; }
    /// Number of a pixel in the crop, row by row; it must be held.
    void remove(std::size_t pixel) {
        holds_[pixel] = 0;
        --count_;
    }

  private:
    Crop crop_;
    std::size_t count_;
    std::vector<std::uint8_t> holds_;
};

struct Tile {
    int x0, y0, x1, y1;
};

/// What a tile's kernel is asked for.
struct TileWork {
    Tile tile;
    SampleRange samples;
    const PixelMask* only = nullptr; ///< null: all pixels

    [[nodiscard]] bool wants(int x, int y) const { return only == nullptr || only->holds(x, y); }
};

/// Adds the samples of one tile to the film. A set `cancel` ends it early: pixels keep what they
/// have.
using TileKernel = RayCounts (*)(const RenderJob& job, const Intersector& intersector,
                                 const TileWork& work, const std::atomic<bool>& cancel, Film& film);

/// The threads and the kernel of one render.
class TileRenderer {
  public:
    /// Share of the tiles done in (0,1], and the rays so far; by one thread at a time.
    using TileDone = std::function<void(double share, std::uint64_t rays)>;

    /// All must outlive it.
    TileRenderer(const Features& needed, const Intersector& intersector,
                 const RenderOptions& options);

    [[nodiscard]] std::string_view profile() const { return profile_; }
    [[nodiscard]] bool cancelled() const { return cancel_.load(std::memory_order_relaxed); }

    /// Adds samples of the pixels of the job's crop to `film`, and their rays to `stats`. A
    /// pixel's samples are added in order whatever the cuts into ranges, so they change no bit.
    void render(const RenderJob& job, SampleRange samples, const PixelMask* only, Film& film,
                RayCounts& rays, const TileDone& done) const;

  private:
    const Intersector& intersector_;
    const std::atomic<bool>& cancel_;
    std::string_view profile_;
    TileKernel kernel_;
    Workers workers_;
};

} // namespace plumb
