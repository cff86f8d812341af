/// \file  What RayTracer needs of the side on which rays are traced.
#pragma once

#include "cuda/ray_tracer.h"

namespace plumb {

class RayTracer::Side {
  public:
    Side() = default;
    Side(const Side&) = delete;
    Side& operator=(const Side&) = delete;
    virtual ~Side() = default;

    virtual void load(std::span<const Ray> rays) = 0;
    virtual double trace(bool any_hit) = 0;
    virtual void fetch(std::span<Hit> hits) const = 0;
    virtual void fetch(std::span<std::uint8_t> found) const = 0;
    [[nodiscard]] virtual std::vector<KernelReport> kernels(bool any_hit) const = 0;
};

/// `trees` may go once it is made. Throws DeviceError.
[[nodiscard]] std::unique_ptr<RayTracer::Side> make_device_side(const TreeViews& trees,
                                                                CudaTree tree, TriangleTest test);
[[nodiscard]] std::unique_ptr<RayTracer::Side> make_host_side(const TreeViews& trees, CudaTree tree,
                                                              TriangleTest test);

} // namespace plumb
