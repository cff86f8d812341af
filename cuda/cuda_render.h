/// \file  Rendering on a GPU: the same film, bit for bit, as on the CPU.
///
/// Builds without nvcc have these functions too (no_cuda.cpp); there is then never a device.
#pragma once

#include "accel/sah/sah_view.h"
#include "cuda/device_error.h"
#include "renderer/integrate/render.h"

#include <string>

namespace plumb {

/// Whether there is a device that can run the kernels. `why`, if given, says in one line why not;
/// it begins with "cuda: ".
[[nodiscard]] bool cuda_available(std::string* why = nullptr);

/// Renders on the first device. `tree`: of the job's geometry; host memory, as all of `job`.
/// options.threads is ignored. Throws DeviceError: no device, not enough device memory, a kernel
/// that failed; `stats` is then of no use.
[[nodiscard]] Film render_on_cuda(const RenderJob& job, const Features& needed, const SahView& tree,
                                  TriangleTest test, const RenderOptions& options,
                                  RenderStats& stats);

} // namespace plumb
