/// \file  The path tracer in stages, a kernel each, over all paths of a wave: host and device.
///
/// S. Laine, T. Karras, T. Aila, "Megakernels Considered Harmful: Wavefront Path Tracing on GPUs",
/// HPG 2013. The stages are the steps of trace_path (path.h) in its order, so each path sums up the
/// same numbers in the same order. Queues are closed up by counters that all threads share: where a
/// path stands in a queue is a matter of chance, what becomes of it is not, since it keeps its slot
/// and pixels add the slots of their samples in order.
#pragma once

#include "cuda/persistent.h"
#include "cuda/render_kernel.h"

#include <array>

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

/// How many entries the queues have that the shade stage fills at a depth, and how many rays of the
/// queue before were taken by persistent threads.
struct WaveCounters {
    std::uint32_t next = 0, shadow = 0, taken = 0;
};

/// Depths that are launched before the host asks how many paths are left: it would wait for each.
inline constexpr std::size_t depths_ahead = 8;

/// Of the depths of one such run.
using RunCounters = std::array<WaveCounters, depths_ahead>;

/// Memory of a wave, a slot each path of its batch.
struct WaveView {
    PathState* paths = nullptr;    ///< by slot
    Hit* hits = nullptr;           ///< by place in the queue
    std::uint32_t* now = nullptr;  ///< slots of the paths that live
    std::uint32_t* next = nullptr; ///< and of those that go on
    ShadowEntry* shadows = nullptr;
    RunCounters* counters = nullptr;
};

/// What the stages are launched with.
struct WaveJob {
    DeviceJob device; ///< batch: the samples of this wave
    WaveView wave;
    std::uint32_t threads = 0; ///< of the launch: as many as items, or more
    int depth = 1;
    std::uint32_t ahead = 0; ///< depths of this run before this one; 0: a thread a path

    [[nodiscard]] RT_HD std::uint32_t paths() const {
        return ahead == 0 ? threads : (*wave.counters)[ahead - 1].next;
    }
    [[nodiscard]] RT_HD WaveCounters& filled() const { return (*wave.counters)[ahead]; }
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
    if (at.index() >= job.device.batch.slots())
        return;
    const auto slot = static_cast<std::uint32_t>(at.index());
    const SlotSample sample(job.device.job.crop, job.device.batch, slot);
    const CameraSample camera =
        sample.camera(job.device.job, *job.device.filter, sample.sampler(job.device.job));
    job.wave.paths[slot] = {PathSteps<F>::start(camera.ray), {}, camera.weight};
    job.wave.now[slot] = slot;
}

/// Item i: the closest hit of the i-th path of the queue.
template <TriangleTest Test, CudaTree Tree>
RT_HD void extend_thread(const WaveJob& job, GridPosition at) {
    if (at.index() >= job.paths())
        return;
    const TreeQuery<Test, Tree> query{job.device.trees};
    const Ray ray = job.wave.paths[job.wave.now[at.index()]].path.ray;
    job.wave.hits[at.index()] = query.closest(ray);
}

/// The same for persistent threads.
struct ExtendItems {
    const WaveJob& job;
    std::uint32_t paths = job.paths(); ///< read once

    [[nodiscard]] RT_HD std::uint32_t count() const { return paths; }
    [[nodiscard]] RT_HD Ray ray(std::uint32_t i) const {
        return job.wave.paths[job.wave.now[i]].path.ray;
    }
    RT_HD void store(std::uint32_t i, const Hit& hit) const { job.wave.hits[i] = hit; }
};

/// Item i: all that happens to the i-th path at its hit: one round of the loop in trace_path.
template <Features F> RT_HD void shade_thread(const WaveJob& job, GridPosition at) {
    if (at.index() >= job.paths())
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
            wave.shadows[detail::take_place(job.filled().shadow)] = {direct.shadow, direct.radiance,
                                                                     slot};
    }
    if (!steps.scatter(path, vertex, u.direction) ||
        !steps.survives(path.throughput, depth, u.roulette))
        return;
    state.path = path;
    wave.next[detail::take_place(job.filled().next)] = slot;
}

/// Item i: the i-th shadow ray. A path has at most one a depth: no two threads meet in a slot.
template <TriangleTest Test, CudaTree Tree>
RT_HD void shadow_thread(const WaveJob& job, GridPosition at) {
    if (at.index() >= job.filled().shadow)
        return;
    const TreeQuery<Test, Tree> query{job.device.trees};
    const ShadowEntry& entry = job.wave.shadows[at.index()];
    const Ray ray = entry.ray;
    if (!query.occluded(ray))
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
