/// \file  The 8-wide SAH tree as an Intersector.
#pragma once

#include "accel/intersector.h"
#include "accel/sah/isa/kernels.h"

namespace plumb {

class SahIntersector final : public Intersector {
  public:
    /// Builds; see build_binary and collapse for what it throws, and std::runtime_error for an
    /// instruction set that this processor lacks.
    SahIntersector(const GeometryView& geometry, const BuildOptions& options);

    [[nodiscard]] Hit closest(const Ray& ray) const override {
        return kernels_.closest(view_, ray);
    }
    [[nodiscard]] bool occluded(const Ray& ray) const override {
        return kernels_.occluded(view_, ray);
    }
    void closest(std::span<const Ray> rays, std::span<Hit> hits) const override {
        kernels_.closest_stream(view_, rays, hits);
    }
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> found) const override {
        kernels_.occluded_stream(view_, rays, found);
    }
    [[nodiscard]] TraversalCounts count(std::span<const Ray> rays, bool any_hit) const override {
        return kernels_.count(view_, rays, any_hit);
    }
    [[nodiscard]] AccelStats stats() const override { return stats_; }
    [[nodiscard]] const WideView& view() const { return view_; }

  private:
    WideBvh tree_;
    WideView view_;
    WideKernels kernels_;
    AccelStats stats_;
};

} // namespace plumb
