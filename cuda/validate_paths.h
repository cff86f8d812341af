/// \file  Renders on the CPU and has a device answer the same rays: which is the first to differ?
#pragma once

#include "accel/intersector.h"
#include "renderer/integrate/render.h"

#include <optional>
#include <string>

namespace plumb {

/// A ray on which the two differ, and where it is in the render.
struct PathDifference {
    int x = 0, y = 0;
    std::uint32_t sample = 0;
    int bounce = 0;      ///< 0: the camera ray, or the shadow ray from where that hit
    bool shadow = false; ///< an any-hit query; the hits are then what closest() says
    Ray ray;
    Hit cpu, device;
};

struct PathValidation {
    RayCounts rays, different;
    std::optional<PathDifference> first; ///< in the order of pixels, samples and bounces
};

/// Renders as render() does, ray by ray on the calling thread, and adds to `found` what `device`
/// answers differently, in any bit; of any-hit queries the answer itself. `stats` as render() sets
/// them.
[[nodiscard]] Film validate_paths(const RenderJob& job, const Features& needed,
                                  const Intersector& cpu, const Intersector& device,
                                  const RenderOptions& options, RenderStats& stats,
                                  PathValidation& found);

/// Some lines that end in a newline. `cpu`: the name of its structure.
[[nodiscard]] std::string text_of(const PathValidation& found, std::string_view cpu);

} // namespace plumb
