/// \file  Rendering on a GPU: the same film, bit for bit, as on the CPU.
///
/// Builds without nvcc have these functions too (no_cuda.cpp); there is then never a device.
#pragma once

#include "cuda/device_error.h"
#include "cuda/device_report.h"
#include "cuda/device_tree.h"
#include "renderer/integrate/render.h"

#include <string>

namespace plumb {

/// Whether there is a device that can run the kernels. `why`, if given, says in one line why not;
/// it begins with "cuda: ".
[[nodiscard]] bool cuda_available(std::string* why = nullptr);

/// Name of the first device. Throws NoDeviceError where there is none, DeviceError where it cannot
/// be used.
[[nodiscard]] std::string cuda_device_name();

/// Renders on the first device. `trees`: the one that the settings name, of the job's geometry;
/// host memory, as all of `job`. options.threads is ignored. `report`, if given, is filled in.
/// Throws DeviceError: no device, not enough device memory, a kernel that failed; `stats` is then
/// of no use.
[[nodiscard]] Film render_on_cuda(const RenderJob& job, const Features& needed,
                                  const TreeViews& trees, TriangleTest test,
                                  const CudaSettings& settings, const RenderOptions& options,
                                  RenderStats& stats, DeviceReport* report = nullptr);

} // namespace plumb
