/// \file  The path tracer: one kernel for every intersector, host and device.
///
/// J. Kajiya, "The Rendering Equation", SIGGRAPH 1986; light and BSDF samples are combined by the
/// power heuristic of E. Veach, L. Guibas, "Optimally Combining Sampling Techniques", SIGGRAPH
/// 1995.
#pragma once

#include "renderer/integrate/path_steps.h"

namespace plumb {

/// Rays traced, by kind.
struct RayCounts {
    std::uint64_t camera = 0, bounce = 0, shadow = 0;

    [[nodiscard]] RT_HD std::uint64_t total() const { return camera + bounce + shadow; }
    RT_HD RayCounts& operator+=(const RayCounts& o) {
        camera += o.camera;
        bounce += o.bounce;
        shadow += o.shadow;
        return *this;
    }
};

/// Radiance arriving along a camera ray, one sample, ray by ray. Finite for finite scenes. `F`:
/// what the kernel can do, must cover the scene. `Query` has `Hit closest(const Ray&) const` and
/// `bool occluded(const Ray&) const`. PathStream does the same for many paths at a time.
template <Features F, class Query>
[[nodiscard]] RT_HD Rgb trace_path(const PathSteps<F>& steps, const Query& query, const Ray& ray,
                                   const Sampler& sampler, RayCounts& counts) {
    Path path = PathSteps<F>::start(ray);
    Rgb radiance;
    for (int depth = 1;; ++depth) {
        ++(depth == 1 ? counts.camera : counts.bounce);
        const Hit hit = query.closest(path.ray);
        if (!hit.valid())
            return radiance + steps.environment(path, depth);
        const Vertex vertex = steps.vertex_at(hit, path);
        radiance += steps.emission(path, vertex, depth);
        if (steps.ends_at(vertex, depth))
            return radiance;
        const BounceNumbers u = steps.numbers(sampler, depth);
        if (steps.samples_lights()) {
            const DirectLight direct = steps.direct_light(path, vertex, u.light_point, u.light);
            if (direct.counts) {
                ++counts.shadow;
                if (!query.occluded(direct.shadow))
                    radiance += direct.radiance;
            }
        }
        if (!steps.scatter(path, vertex, u.direction) ||
            !steps.survives(path.throughput, depth, u.roulette))
            return radiance;
    }
}

} // namespace plumb
