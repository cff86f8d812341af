/// \file  The path tracer in stages, a kernel each, over all paths of a wave: host and device.
///
/// S. Laine, T. Karras, T. Aila, "Megakernels Considered Harmful: Wavefront Path Tracing on GPUs",
/// HPG 2013. The stages are the steps of trace_path (path.h) in its order, so each path sums up the
/// same numbers in the same order. Queues are closed up by counters that all threads share: where a
/// path stands in a queue is a matter of chance, what becomes of it is not, since it keeps its slot
/// and pixels add the slots of their samples in order.
#pragma once

#include "cuda/render_kernel.h"

namespace plumb {

/// A path between the stages. All paths of a wave are at the same depth.
struct alignas(16) PathState {
    Path path;
    Rgb radiance;
    float weight; ///< of the camera sample
};

/// A shadow ray on its way, and what it brings to the path in `slot` if nothing is in between.
struct alignas(16) ShadowEntry {
    Ray ray;
    Rgb radiance;
    std::uint32_t slot;
};
static_assert(sizeof(ShadowEntry) == 48);

/// How many entries the queues have that the shade stage fills.
struct WaveCounters {
    std::uint32_t next = 0, shadow = 0;
};

/// Memory of a wave, a slot each path of its batch.
struct WaveView {
    PathState* paths = nullptr;    ///< by slot
    Hit* hits = nullptr;           ///< by place in the queue
    std::uint32_t* now = nullptr;  ///< slots of the paths that live
    std::uint32_t* next = nullptr; ///< and of those that go on
    ShadowEntry* shadows = nullptr;
    WaveCounters* counters = nullptr;
};

/// What the stages are launched with.
struct WaveJob {
    DeviceJob device; ///< batch: the samples of this wave
    WaveView wave;
    std::uint32_t count = 0; ///< items of the launch
    int depth = 1;
};

namespace detail {

/// The next free place of a queue.
RT_HD inline std::uint32_t take_place(std::uint32_t& counter) {
#ifdef __CUDA_ARCH__
    return atomicAdd(&counter, 1u);
#else
    return counter++;
#endif
}

} // namespace detail

/// Item i: the camera ray of slot i.
template <Features F> RT_HD void generate_thread(const WaveJob& job, GridPosition at) {
    if (at.index() >= job.count)
        return;
    const auto slot = static_cast<std::uint32_t>(at.index());
    const SlotSample sample(job.device.job.crop, job.device.batch, slot);
    const Sample4 u = sample.sampler(job.device.job).group(0);
    const CameraSample camera = camera_sample(job.device.job, sample.x, sample.y, {u.x[0], u.x[1]});
    job.wave.paths[slot] = {PathSteps<F>::start(camera.ray), {}, camera.weight};
    job.wave.now[slot] = slot;
}

/// Item i: the closest hit of the i-th path of the queue.
template <TriangleTest Test, CudaTree Tree>
RT_HD void extend_thread(const WaveJob& job, GridPosition at) {
    if (at.index() >= job.count)
        return;
    const TreeQuery<Test, Tree> query{job.device.trees};
    job.wave.hits[at.index()] = query.closest(job.wave.paths[job.wave.now[at.index()]].path.ray);
}

/// Item i: all that happens to the i-th path at its hit: one round of the loop in trace_path.
template <Features F> RT_HD void shade_thread(const WaveJob& job, GridPosition at) {
    if (at.index() >= job.count)
        return;
    const RenderJob& render = job.device.job;
    const WaveView& wave = job.wave;
    const PathSteps<F> steps(render.scene, render.path);
    const int depth = job.depth;
    const std::uint32_t slot = wave.now[at.index()];
    const Hit hit = wave.hits[at.index()];
    PathState& state = wave.paths[slot];
    Path path = state.path;
    if (!hit.valid()) {
        state.radiance = state.radiance + steps.environment(path, depth);
        return;
    }
    const Vertex vertex = steps.vertex_at(hit, path);
    state.radiance += steps.emission(path, vertex, depth);
    if (steps.ends_at(vertex, depth))
        return;
    const BounceNumbers u =
        steps.numbers(SlotSample(render.crop, job.device.batch, slot).sampler(render), depth);
    if (steps.samples_lights()) {
        const DirectLight direct = steps.direct_light(path, vertex, u.light_point, u.light);
        if (direct.counts)
            wave.shadows[detail::take_place(wave.counters->shadow)] = {direct.shadow,
                                                                       direct.radiance, slot};
    }
    if (!steps.scatter(path, vertex, u.direction) ||
        !steps.survives(path.throughput, depth, u.roulette))
        return;
    state.path = path;
    wave.next[detail::take_place(wave.counters->next)] = slot;
}

/// Item i: the i-th shadow ray. A path has at most one a depth: no two threads meet in a slot.
template <TriangleTest Test, CudaTree Tree>
RT_HD void shadow_thread(const WaveJob& job, GridPosition at) {
    if (at.index() >= job.count)
        return;
    const TreeQuery<Test, Tree> query{job.device.trees};
    const ShadowEntry& entry = job.wave.shadows[at.index()];
    if (!query.occluded(entry.ray))
        job.wave.paths[entry.slot].radiance += entry.radiance;
}

/// Item i: adds the samples of pixel i of the batch.
RT_HD inline void accumulate_thread(const WaveJob& job, GridPosition at) {
    add_samples(job.device.batch, job.device.film, job.device.with_variance, at,
                [&](std::uint64_t slot) {
                    const PathState& state = job.wave.paths[slot];
                    return state.radiance * state.weight;
                });
}

} // namespace plumb
