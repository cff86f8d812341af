/// \file  Renders a scene on the CPU: tiles, threads, progress.
#pragma once

#include "accel/intersector.h"
#include "renderer/integrate/film.h"
#include "renderer/integrate/pixel.h"
#include "renderer/integrate/stopping.h"

#include <atomic>
#include <functional>

namespace plumb {

/// What a render did.
struct RenderStats {
    RayCounts rays;
    std::uint64_t samples = 0; ///< camera paths
    double render_s = 0;
    std::string_view profile;
    StoppedBy stopped_by = StoppedBy::spp;
    std::optional<Reached> reached; ///< with StopSettings only
};

/// How far a render is.
struct ProgressState {
    double done = 0; ///< share in [0,1]; with StopSettings an estimate
    std::uint64_t rays = 0;
    double error = 0; ///< relative error reached; 0: not known
};

/// Called from any worker after each tile, by one at a time.
using Progress = std::function<void(const ProgressState&)>;

struct RenderOptions {
    int threads = 0;                 ///< 0: all cores
    bool variance = false;           ///< keep each pixel's sample variance
    bool force_full_profile = false; ///< run the general kernel whatever the scene needs
    bool ray_by_ray = false;         ///< no streams: what a GPU thread does, the same bits
    StopSettings stop;               ///< the job's spp stays the upper bound
    Progress progress;
    /// Set to end early: pixels keep the samples they have, those without any are black.
    const std::atomic<bool>* cancel = nullptr;
};

/// The job that renders `scene` as its settings say. `tables` must outlive it.
[[nodiscard]] RenderJob make_job(const Scene& scene, const SceneView& view);

/// Renders on the CPU. The film is the same bits for any number of threads, with a time limit for
/// one that reaches as many samples.
[[nodiscard]] Film render(const RenderJob& job, const Features& needed,
                          const Intersector& intersector, const RenderOptions& options,
                          RenderStats& stats);

} // namespace plumb
