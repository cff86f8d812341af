/// \file  Batches of rays on the device; no header of CUDA, and no CUDA in a build without it.
#pragma once

#include "cuda/ray_tracer.h"

namespace plumb {

/// What RayTracer does on RaySide::device.
class DeviceRays {
  public:
    /// `trees` may go once it is made. Throws DeviceError, as all members do.
    DeviceRays(const TreeViews& trees, CudaTree tree, TriangleTest test);
    ~DeviceRays();
    DeviceRays(const DeviceRays&) = delete;
    DeviceRays& operator=(const DeviceRays&) = delete;

    void load(std::span<const Ray> rays);
    double trace(bool any_hit, RayThreads threads);
    void fetch(std::span<Hit> hits) const;
    void fetch(std::span<std::uint8_t> found) const;
    [[nodiscard]] std::vector<KernelReport> kernels(bool any_hit, RayThreads threads) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace plumb
