/// \file  The ray kernels that ray_kernel.cu compiles, for the host code beside them.
#pragma once

#include "cuda/device_report.h"
#include "cuda/ray_kernel.h"

namespace plumb {

/// Starts the kernel; returns before it is done. Throws DeviceError where it cannot start.
void launch_rays(const RayJob& job, CudaTree tree, TriangleTest test, bool any_hit);
void launch_rays_persistently(const RayJob& job, TriangleTest test);

[[nodiscard]] KernelReport ray_kernel_report(CudaTree tree, TriangleTest test, bool any_hit);
[[nodiscard]] KernelReport persistent_kernel_report(TriangleTest test);

} // namespace plumb
