/// \file  The kernels that path_kernel.cu compiles, for the host code beside it.
#pragma once

#include "cuda/render_kernel.h"

namespace plumb {

/// The kernels that are compiled. The Möller-Trumbore test is there for comparison: no kernel of
/// its own for simple scenes.
enum class PathKernel : std::uint8_t { box, full, full_moeller_trumbore };

/// Starts the kernel for one batch; returns before it is done. Throws DeviceError where it cannot
/// start.
void launch_path_kernel(const DeviceJob& device, PathKernel kind);

/// Throws DeviceError where the device cannot run the code that was compiled.
void check_path_kernel();

} // namespace plumb
