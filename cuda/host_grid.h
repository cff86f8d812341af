/// \file  Rendering by the kernels of the GPU on the host: slow, for tests and machines without
/// one.
#pragma once

#include "cuda/device_tree.h"
#include "cuda/host_executor.h"

namespace plumb {

/// What render_on_cuda does, each thread after the other on the calling one. The film is the same
/// bits for any grid.
[[nodiscard]] Film render_on_host_grid(const RenderJob& job, const Features& needed,
                                       const TreeViews& trees, TriangleTest test,
                                       const CudaSettings& settings, const HostGrid& grid,
                                       const RenderOptions& options, RenderStats& stats);

} // namespace plumb
