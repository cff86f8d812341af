#include "renderer/integrate/tiles.h"

#include "renderer/integrate/path_stream.h"

#include <mutex>

namespace plumb {
namespace {

constexpr int tile_size = 16;
constexpr int block_size = 4;                  // pixels whose samples are neighbours in a stream
constexpr std::uint32_t samples_in_block = 16; // of each pixel
const std::atomic<bool> never{false};

/// The query of the CPU kernels: any Intersector.
struct IntersectorQuery {
    const Intersector& intersector;

    [[nodiscard]] Hit closest(const Ray& ray) const { return intersector.closest(ray); }
    [[nodiscard]] bool occluded(const Ray& ray) const { return intersector.occluded(ray); }
};

/// The tiles of a crop that have a pixel to render.
std::vector<Tile> tiles_of(const Crop& crop, const PixelMask* only) {
    std::vector<Tile> tiles;
    const int x_end = crop.x + crop.width, y_end = crop.y + crop.height;
    const auto has_work = [only](const Tile& t) {
        for (int y = t.y0; only != nullptr && y < t.y1; ++y)
            for (int x = t.x0; x < t.x1; ++x)
                if (only->holds(x, y))
                    return true;
        return only == nullptr;
    };
    for (int y = crop.y; y < y_end; y += tile_size)
        for (int x = crop.x; x < x_end; x += tile_size) {
            const Tile tile{x, y, std::min(x + tile_size, x_end), std::min(y + tile_size, y_end)};
            if (has_work(tile))
                tiles.push_back(tile);
        }
    return tiles;
}

/// Path by path, ray by ray: what a GPU thread does.
template <Features F>
RayCounts render_tile_ray_by_ray(const RenderJob& job, const Intersector& intersector,
                                 const TileWork& work, const std::atomic<bool>& cancel,
                                 Film& film) {
    const IntersectorQuery query{intersector};
    const Tile& tile = work.tile;
    RayCounts counts;
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x) {
            if (!work.wants(x, y))
                continue;
            FilmPixel& pixel = film.pixel(x, y);
            for (std::uint32_t s = work.samples.first; s < work.samples.end; ++s) {
                if (s % 64 == 0 && cancel.load(std::memory_order_relaxed))
                    return counts;
                pixel.add(sample_pixel<F>(job, query, x, y, s, counts), film.with_variance());
            }
        }
    return counts;
}

/// The same in streams. Neighbours in the stream are samples of one pixel, then pixels of a small
/// block: their rays run alike.
template <Features F>
RayCounts render_tile(const RenderJob& job, const Intersector& intersector, const TileWork& work,
                      const std::atomic<bool>& cancel, Film& film) {
    const Tile& tile = work.tile;
    RayCounts counts;
    PathStream<F> stream(job, intersector);
    const int reuse = job.path.reuse;
    const auto add_sharing = [&](int x0, int y0, std::uint32_t first, std::uint32_t end) {
        const int x1 = std::min(x0 + reuse, tile.x1), y1 = std::min(y0 + reuse, tile.y1);
        for (std::uint32_t s = first; s < end; ++s) {
            if (stream.room() < max_sharing)
                stream.trace(film, counts);
            for (int y = y0; y < y1; ++y)
                for (int x = x0; x < x1; ++x)
                    stream.add(x, y, s);
            stream.end_group();
        }
    };
    const auto add_block = [&](int x0, int y0, std::uint32_t first) {
        const std::uint32_t end = first + std::min(samples_in_block, work.samples.end - first);
        if (reuse > 1) {
            for (int y = y0; y < std::min(y0 + block_size, tile.y1); y += reuse)
                for (int x = x0; x < std::min(x0 + block_size, tile.x1); x += reuse)
                    add_sharing(x, y, first, end);
            return end;
        }
        for (int y = y0; y < std::min(y0 + block_size, tile.y1); ++y)
            for (int x = x0; x < std::min(x0 + block_size, tile.x1); ++x) {
                if (!work.wants(x, y))
                    continue;
                for (std::uint32_t s = first; s < end; ++s) {
                    stream.add(x, y, s);
                    if (stream.full())
                        stream.trace(film, counts);
                }
            }
        return end;
    };
    for (int y = tile.y0; y < tile.y1; y += block_size)
        for (int x = tile.x0; x < tile.x1; x += block_size)
            for (std::uint32_t s = work.samples.first; s < work.samples.end; s = add_block(x, y, s))
                if (cancel.load(std::memory_order_relaxed)) {
                    stream.trace(film, counts);
                    return counts;
                }
    stream.trace(film, counts);
    return counts;
}

template <Features F> TileKernel tile_kernel(bool ray_by_ray) {
    return ray_by_ray ? render_tile_ray_by_ray<F> : render_tile<F>;
}

bool needs_box_only(const Features& needed, const RenderOptions& options) {
    return box_profile.covers(needed) && !options.force_full_profile;
}

} // namespace

TileRenderer::TileRenderer(const Features& needed, const Intersector& intersector,
                           const RenderOptions& options)
    : intersector_(intersector), cancel_(options.cancel != nullptr ? *options.cancel : never),
      profile_(profile_name(needs_box_only(needed, options) ? box_profile : full_profile)),
      kernel_(needs_box_only(needed, options) ? tile_kernel<box_profile>(options.ray_by_ray)
                                              : tile_kernel<full_profile>(options.ray_by_ray)),
      workers_(options.threads) {}

void TileRenderer::render(const RenderJob& job, SampleRange samples, const PixelMask* only,
                          Film& film, RayCounts& rays, const TileDone& done) const {
    RenderJob part = job;
    part.sampler.spp = samples.end; // the kernels of short sequences serve the beginning of longer
    const std::vector<Tile> tiles = tiles_of(job.crop, only);
    std::mutex mutex; // guards rays, the count and the callback
    std::size_t tiles_done = 0;
    workers_.for_each(tiles.size(), [&](std::size_t i) {
        const TileWork work{tiles[i], samples, only};
        const RayCounts counts = kernel_(part, intersector_, work, cancel_, film);
        const std::scoped_lock lock(mutex);
        rays += counts;
        ++tiles_done;
        if (done)
            done(static_cast<double>(tiles_done) / static_cast<double>(tiles.size()), rays.total());
    });
}

} // namespace plumb
