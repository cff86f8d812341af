/// \file  One sample of one pixel, host and device.
#pragma once

#include "renderer/integrate/path.h"
#include "renderer/sampling/film_filter.h"

namespace plumb {

/// All that a kernel needs beside the ray queries. Plain values and spans.
struct RenderJob {
    SceneView scene;
    FilterTable filter;
    PathSettings path;
    SamplerSettings sampler;
    int width = 0, height = 0; ///< of the full film
    Crop crop;
};

/// Weighted radiance of sample `index` of pixel (x, y) of the full film: a pure function of its
/// arguments. The mean over all samples is the filtered image.
template <Features F, class Query>
RT_HD Rgb sample_pixel(const RenderJob& job, const Query& query, int x, int y, std::uint32_t index,
                       RayCounts& counts) {
    const auto pixel = static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(job.width) +
                       static_cast<std::uint32_t>(x);
    const Sampler sampler(job.sampler.kind, job.sampler.seed, pixel, index);
    const Sample4 u = sampler.group(0);
    const FilterSample fx = sample_filter(job.filter, u.x[0]);
    const FilterSample fy = sample_filter(job.filter, u.x[1]);
    const Vec2 image{(static_cast<float>(x) + 0.5f + fx.offset) / static_cast<float>(job.width),
                     (static_cast<float>(y) + 0.5f + fy.offset) / static_cast<float>(job.height)};
    const PathTracer<F, Query> tracer(job.scene, query, job.path);
    return tracer.trace(job.scene.camera.ray_through(image), sampler, counts) *
           (fx.weight * fy.weight);
}

} // namespace plumb
