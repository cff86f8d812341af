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

/// A ray through the film with the weight of what it brings.
struct CameraSample {
    Ray ray;
    float weight; ///< mean 1
};

/// Number of a pixel of the full film, as the sampler knows it.
RT_HD inline std::uint32_t pixel_number(const RenderJob& job, int x, int y) {
    return static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(job.width) +
           static_cast<std::uint32_t>(x);
}

/// A point on the film around the centre of pixel (x, y), for u uniform in [0,1)^2. `filter` equals
/// job.filter: a GPU has it in other memory than the job.
RT_HD inline CameraSample camera_sample(const RenderJob& job, const FilterTable& filter, int x,
                                        int y, Vec2 u) {
    const FilterSample fx = sample_filter(filter, u.x);
    const FilterSample fy = sample_filter(filter, u.y);
    const Vec2 image{(static_cast<float>(x) + 0.5f + fx.offset) / static_cast<float>(job.width),
                     (static_cast<float>(y) + 0.5f + fy.offset) / static_cast<float>(job.height)};
    return {job.scene.camera.ray_through(image), fx.weight * fy.weight};
}

/// Weighted radiance of sample `index` of pixel (x, y) of the full film: a pure function of its
/// arguments. The mean over all samples is the filtered image.
template <Features F, class Query>
Rgb sample_pixel(const RenderJob& job, const Query& query, int x, int y, std::uint32_t index,
                 RayCounts& counts) {
    const Sampler sampler(job.sampler.kind, job.sampler.seed, pixel_number(job, x, y), index);
    const Sample4 u = sampler.group(0);
    const CameraSample camera = camera_sample(job, job.filter, x, y, {u.x[0], u.x[1]});
    const PathSteps<F> steps(job.scene, job.path);
    return trace_path(steps, query, camera.ray, sampler, counts) * camera.weight;
}

} // namespace plumb
