/// \file  The kernels that the .cu files compile, for the host code beside them.
#pragma once

#include "cuda/device_report.h"
#include "cuda/wave_runner.h"

namespace plumb {

/// Starts the megakernel for one wave, and the sums of its pixels; returns before they are done.
/// Throws DeviceError where they cannot start.
void launch_path_kernel(const DeviceJob& device, PathKernel kind, CudaTree tree);

/// Starts a stage of the wavefront, likewise.
void launch_wave_stage(WaveStage stage, const WaveJob& job, PathKernel kind, CudaTree tree);

/// Throws DeviceError where the device cannot run the code that was compiled.
void check_path_kernel();

/// What the kernels of a render take of the device.
[[nodiscard]] std::vector<KernelReport> path_kernel_reports(PathKernel kind, CudaTree tree);
[[nodiscard]] std::vector<KernelReport> wave_kernel_reports(PathKernel kind,
                                                            const CudaSettings& settings);

} // namespace plumb
