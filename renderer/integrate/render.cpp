#include "renderer/integrate/render.h"

#include "accel/parallel/parallel.h"
#include "renderer/integrate/path_stream.h"

#include <chrono>
#include <mutex>

namespace plumb {
namespace {

constexpr int tile_size = 16;
constexpr int block_size = 4;                  // pixels whose samples are neighbours in a stream
constexpr std::uint32_t samples_in_block = 16; // of each pixel

/// The query of the CPU kernels: any Intersector.
struct IntersectorQuery {
    const Intersector& intersector;

    [[nodiscard]] Hit closest(const Ray& ray) const { return intersector.closest(ray); }
    [[nodiscard]] bool occluded(const Ray& ray) const { return intersector.occluded(ray); }
};

struct Tile {
    int x0, y0, x1, y1;
};

Tile tile_at(const Crop& crop, std::size_t index) {
    const int columns = (crop.width + tile_size - 1) / tile_size;
    const int x0 = crop.x + static_cast<int>(index % static_cast<std::size_t>(columns)) * tile_size;
    const int y0 = crop.y + static_cast<int>(index / static_cast<std::size_t>(columns)) * tile_size;
    return {x0, y0, std::min(x0 + tile_size, crop.x + crop.width),
            std::min(y0 + tile_size, crop.y + crop.height)};
}

std::size_t tile_count(const Crop& crop) {
    const auto tiles = [](int n) {
        return static_cast<std::size_t>((n + tile_size - 1) / tile_size);
    };
    return tiles(crop.width) * tiles(crop.height);
}

/// Renders the pixels of one tile. A set `cancel` ends it early: they keep the samples they have.
using TileKernel = RayCounts (*)(const RenderJob& job, const Intersector& intersector,
                                 const Tile& tile, const std::atomic<bool>& cancel, Film& film);

/// Path by path, ray by ray: what a GPU thread does.
template <Features F>
RayCounts render_tile_ray_by_ray(const RenderJob& job, const Intersector& intersector,
                                 const Tile& tile, const std::atomic<bool>& cancel, Film& film) {
    const IntersectorQuery query{intersector};
    RayCounts counts;
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x) {
            FilmPixel& pixel = film.pixel(x, y);
            for (std::uint32_t s = 0; s < job.sampler.spp; ++s) {
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
RayCounts render_tile(const RenderJob& job, const Intersector& intersector, const Tile& tile,
                      const std::atomic<bool>& cancel, Film& film) {
    RayCounts counts;
    PathStream<F> stream(job, intersector);
    const auto add_block = [&](int x0, int y0, std::uint32_t first) {
        const std::uint32_t end = first + std::min(samples_in_block, job.sampler.spp - first);
        for (int y = y0; y < std::min(y0 + block_size, tile.y1); ++y)
            for (int x = x0; x < std::min(x0 + block_size, tile.x1); ++x)
                for (std::uint32_t s = first; s < end; ++s) {
                    stream.add(x, y, s);
                    if (stream.full())
                        stream.trace(film, counts);
                }
        return end;
    };
    for (int y = tile.y0; y < tile.y1; y += block_size)
        for (int x = tile.x0; x < tile.x1; x += block_size)
            for (std::uint32_t s = 0; s < job.sampler.spp; s = add_block(x, y, s))
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

} // namespace

RenderJob make_job(const Scene& scene, const SceneView& view) {
    RenderJob job;
    job.scene = view;
    job.filter = make_filter_table(scene.film.filter);
    job.path = scene.path;
    job.sampler = scene.sampler;
    job.width = scene.film.width;
    job.height = scene.film.height;
    job.crop = scene.film.crop;
    return job;
}

Film render(const RenderJob& job, const Features& needed, const Intersector& intersector,
            const RenderOptions& options, RenderStats& stats) {
    const auto start = std::chrono::steady_clock::now();
    const bool box = box_profile.covers(needed) && !options.force_full_profile;
    stats.profile = box ? profile_name(box_profile) : profile_name(full_profile);
    const TileKernel kernel = box ? tile_kernel<box_profile>(options.ray_by_ray)
                                  : tile_kernel<full_profile>(options.ray_by_ray);
    Film film(job.width, job.height, job.crop, options.variance);
    const std::size_t tiles = tile_count(job.crop);
    const std::atomic<bool> never{false};
    const std::atomic<bool>& cancel = options.cancel != nullptr ? *options.cancel : never;
    std::mutex mutex; // guards stats and the progress callback
    std::size_t done = 0;
    parallel_for(tiles, options.threads, [&](std::size_t i) {
        const RayCounts counts = kernel(job, intersector, tile_at(job.crop, i), cancel, film);
        const std::scoped_lock lock(mutex);
        stats.rays += counts;
        ++done;
        if (options.progress)
            options.progress(static_cast<double>(done) / static_cast<double>(tiles),
                             stats.rays.total());
    });
    stats.samples = stats.rays.camera;
    stats.render_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return film;
}

} // namespace plumb
