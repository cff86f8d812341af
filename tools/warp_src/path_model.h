/// \file  Whole paths of a scene through the model: megakernel and wavefront.
#pragma once

#include "renderer/integrate/pixel.h"
#include "tools/warp_src/order.h"

#include <optional>

namespace plumb::warps {

/// The rays of one sample, by depth.
struct PathVertex {
    Ray ray;
    std::optional<Ray> shadow{};
};
using PathRays = std::vector<PathVertex>;

/// All samples of the job by their slots (cuda/waves.h), traced on the CPU.
[[nodiscard]] std::vector<PathRays> record_paths(const RenderJob& job, const SahView& tree);

enum class PathWay : std::uint8_t {
    megakernel,
    wavefront,
    sorted_wavefront,    ///< rays sorted from the second depth on, at no cost
    persistent_wavefront ///< persistent threads for closest hits from the second depth on
};
inline constexpr std::array<PathWay, 4> path_ways{PathWay::megakernel, PathWay::wavefront,
                                                  PathWay::sorted_wavefront,
                                                  PathWay::persistent_wavefront};
[[nodiscard]] const char* name_of(PathWay way);

struct PathCell {
    CudaTree tree;
    PathWay way;
    Totals totals;          ///< of the multiprocessors looked at
    double paths = 0;       ///< of these
    double paths_per_s = 0; ///< of the GPU
};

/// `paths` are those of one wave. In the megakernel lanes whose path has ended wait for the longest
/// of their warp; in the wavefront the paths that live are closed up before each depth, and go
/// through memory between the stages.
[[nodiscard]] PathCell model_cell(const TreeViews& trees, CudaTree tree,
                                  std::span<const PathRays> paths, PathWay way);

} // namespace plumb::warps
