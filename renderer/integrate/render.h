/// \file  Renders a scene on the CPU: tiles, threads, progress.
#pragma once

#include "accel/intersector.h"
#include "renderer/integrate/film.h"
#include "renderer/integrate/pixel.h"

#include <atomic>
#include <functional>

namespace plumb {

/// What a render did.
struct RenderStats {
    RayCounts rays;
    std::uint64_t samples = 0; ///< camera paths
    double render_s = 0;
    std::string_view profile;
};

/// Called from any worker after each tile with the share done in (0,1] and the rays so far.
using Progress = std::function<void(double done, std::uint64_t rays)>;

struct RenderOptions {
    int threads = 0;                 ///< 0: all cores
    bool variance = false;           ///< keep each pixel's sample variance
    bool force_full_profile = false; ///< run the general kernel whatever the scene needs
    bool ray_by_ray = false;         ///< no streams: what a GPU thread does, the same bits
    Progress progress;
    /// Set to end early: pixels keep the samples they have, those without any are black.
    const std::atomic<bool>* cancel = nullptr;
};

/// The job that renders `scene` as its settings say. `tables` must outlive it.
[[nodiscard]] RenderJob make_job(const Scene& scene, const SceneView& view);

/// Renders on the CPU. The film is the same bits for any number of threads.
[[nodiscard]] Film render(const RenderJob& job, const Features& needed,
                          const Intersector& intersector, const RenderOptions& options,
                          RenderStats& stats);

} // namespace plumb
