/// \file  Radiance by recursion, a call for each bounce: an oracle of failure, for the tests only.
#pragma once

#include "accel/intersector.h"
#include "renderer/integrate/path_steps.h"
#include "renderer/sampling/sampler.h"

namespace plumb::stability {

/// What trace_path gives with Estimator::bsdf and no roulette, but for the rounding of the sum.
template <Features F>
Rgb radiance_by_recursion(const PathSteps<F>& steps, const Intersector& intersector, Path path,
                          const Sampler& sampler, int depth) {
    const Hit hit = intersector.closest(path.ray);
    if (!hit.valid())
        return steps.environment(path, depth);
    const Vertex vertex = steps.vertex_at(hit, path);
    const Rgb emitted = steps.emission(path, vertex, depth);
    if (steps.ends_at(vertex, depth))
        return emitted;
    if (!steps.scatter(path, vertex, steps.numbers(sampler, depth).direction))
        return emitted;
    return emitted + radiance_by_recursion(steps, intersector, path, sampler, depth + 1);
}

} // namespace plumb::stability
