#include "renderer/integrate/render.h"

#include "accel/parallel/parallel.h"

#include <chrono>
#include <mutex>

namespace plumb {
namespace {

constexpr int tile_size = 16;

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

/// A set `cancel` ends it early: the pixels keep the samples they have.
template <Features F>
RayCounts render_tile(const RenderJob& job, const IntersectorQuery& query, const Tile& tile,
                      const std::atomic<bool>& cancel, Film& film) {
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
    const auto kernel = box ? render_tile<box_profile> : render_tile<full_profile>;
    Film film(job.width, job.height, job.crop, options.variance);
    const IntersectorQuery query{intersector};
    const std::size_t tiles = tile_count(job.crop);
    const std::atomic<bool> never{false};
    const std::atomic<bool>& cancel = options.cancel != nullptr ? *options.cancel : never;
    std::mutex mutex; // guards stats and the progress callback
    std::size_t done = 0;
    parallel_for(tiles, options.threads, [&](std::size_t i) {
        const RayCounts counts = kernel(job, query, tile_at(job.crop, i), cancel, film);
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
