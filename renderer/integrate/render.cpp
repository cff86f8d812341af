#include "renderer/integrate/render.h"

#include "renderer/integrate/adaptive.h"
#include "renderer/integrate/deadline.h"
#include "renderer/integrate/pixel_error.h"
#include "renderer/integrate/tiles.h"

namespace plumb {
namespace {

/// All samples in one go.
Film render_all(const RenderJob& job, const TileRenderer& tiles, const RenderOptions& options,
                RenderStats& stats) {
    Film film(job.width, job.height, job.crop, options.variance);
    tiles.render(job, {0, job.sampler.spp}, nullptr, film, stats.rays,
                 [&options](double share, std::uint64_t rays) {
                     if (options.progress)
                         options.progress({share, rays});
                 });
    stats.stopped_by = tiles.cancelled() ? StoppedBy::signal : StoppedBy::spp;
    return film;
}

/// As many samples of every pixel as fit into the time.
Film render_until(const RenderJob& job, const TileRenderer& tiles, const RenderOptions& options,
                  RenderStats& stats) {
    Deadline deadline(options.stop.time_limit_s);
    Film film(job.width, job.height, job.crop, true);
    const double pixels = static_cast<double>(film.pixels().size());
    const double spp = job.sampler.spp;
    std::uint32_t n = 0;
    const auto report = [&](double, std::uint64_t rays) {
        if (options.progress)
            options.progress({std::min(1.0, std::max(deadline.share_used(), n / spp)), rays});
    };
    stats.stopped_by = StoppedBy::spp;
    while (n < job.sampler.spp && !tiles.cancelled()) {
        const std::uint32_t end = deadline.reachable(n, job.sampler.spp, pixels);
        if (end == n) {
            stats.stopped_by = StoppedBy::time_limit;
            break;
        }
        tiles.render(job, {n, end}, nullptr, film, stats.rays, report);
        deadline.passed();
        n = end;
    }
    if (tiles.cancelled())
        stats.stopped_by = StoppedBy::signal;
    return film;
}

Reached reached_by(const Film& film) {
    Reached reached;
    reached.error = error_of_image(film.pixels());
    reached.spp_min = 0xffffffffu;
    for (const FilmPixel& pixel : film.pixels()) {
        reached.spp_min = std::min(reached.spp_min, pixel.count);
        reached.spp_max = std::max(reached.spp_max, pixel.count);
        reached.spp_mean += pixel.count;
    }
    reached.spp_mean /= static_cast<double>(film.pixels().size());
    return reached;
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
    const TileRenderer tiles(needed, intersector, options);
    stats.profile = tiles.profile();
    const auto how = options.stop.target_error > 0   ? render_adaptively
                     : options.stop.time_limit_s > 0 ? render_until
                                                     : render_all;
    Film film = how(job, tiles, options, stats);
    if (options.stop.any()) {
        stats.reached = reached_by(film);
        if (!options.variance)
            film.forget_variance();
    }
    stats.samples = stats.rays.camera;
    stats.render_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return film;
}

} // namespace plumb
