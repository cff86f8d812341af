/// \file  Renders flat scenes with every tree and schedule, compares bits, takes times.
#pragma once

#include "cuda/cuda_render.h"
#include "cuda/flat_scene.h"
#include "tools/gpu_src/options.h"

#include <vector>

namespace plumb::gpu {

/// One scene with one tree and schedule.
struct ImageResult {
    std::string scene, profile;
    CudaSettings settings;
    bool same_image = false, same_rays = false; ///< as on the CPU
    double build_s = 0, render_s = 0;           ///< render_s: median, of `samples` samples
    std::uint64_t samples = 0;
    RayCounts rays; ///< of the timed render
    DeviceReport device;

    [[nodiscard]] bool right() const { return same_image && same_rays; }
};

/// Prints a line for each as it comes and appends it to `results`. Throws DeviceError, and
/// std::runtime_error for files.
void check_images(const Options& options, std::vector<ImageResult>& results);

[[nodiscard]] std::string to_json(const ImageResult& result);

} // namespace plumb::gpu
