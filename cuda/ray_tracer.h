/// \file  Batches of rays through a tree, on a device or through the same kernel on the host.
#pragma once

#include "accel/sah/build_compressed.h"
#include "accel/sah/build_sah.h"
#include "cuda/device_report.h"
#include "cuda/device_tree.h"
#include "cuda/grid.h"

#include <memory>

namespace plumb {

/// Where rays are traced.
enum class RaySide : std::uint8_t { device, host };

/// A tree placed in the memory of a device (or of the host), and a batch of rays. One thread at a
/// time. Without CUDA only the host's side is there.
class RayTracer {
  public:
    /// Builds the tree over `geometry` and uploads it. Throws DeviceError, and what the builds
    /// throw. `threads`: of the build, 0 for all cores.
    RayTracer(RaySide side, const GeometryView& geometry, CudaTree tree, TriangleTest test,
              int threads = 0);
    ~RayTracer();
    RayTracer(const RayTracer&) = delete;
    RayTracer& operator=(const RayTracer&) = delete;

    /// Of the tree.
    [[nodiscard]] const AccelStats& stats() const { return stats_; }
    [[nodiscard]] double upload_s() const { return upload_s_; }

    /// Makes `rays` the batch of the queries that follow.
    void load(std::span<const Ray> rays);
    /// Traces the batch; returns the seconds that the kernel took (on the host: the loop).
    /// Persistent threads find closest hits in the wide tree only.
    double trace(bool any_hit, RayThreads threads = RayThreads::one_a_ray);
    /// What the last trace() found.
    void fetch(std::span<Hit> hits) const;
    void fetch(std::span<std::uint8_t> found) const;

    /// What queries for these rays touch, counted on the host, one by one.
    [[nodiscard]] TraversalCounts count(std::span<const Ray> rays, bool any_hit) const;

    /// What the kernel of closest or any-hit queries takes; nothing on the host.
    [[nodiscard]] std::vector<KernelReport>
    kernels(bool any_hit, RayThreads threads = RayThreads::one_a_ray) const;

  private:
    struct Side;

    SahTree binary_;
    CompressedTree wide_; ///< one of the two is empty
    TreeViews trees_;
    AccelStats stats_;
    double upload_s_ = 0;
    std::unique_ptr<Side> side_;
};

/// Closest and any-hit queries by batches on a device. Safe to call from any number of threads, one
/// of which runs at a time.
class CudaIntersector final : public Intersector {
  public:
    CudaIntersector(RaySide side, const GeometryView& geometry, CudaTree tree, TriangleTest test,
                    int threads = 0);
    ~CudaIntersector() override;

    [[nodiscard]] Hit closest(const Ray& ray) const override;
    [[nodiscard]] bool occluded(const Ray& ray) const override;
    void closest(std::span<const Ray> rays, std::span<Hit> hits) const override;
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> found) const override;
    [[nodiscard]] TraversalCounts count(std::span<const Ray> rays, bool any_hit) const override;
    [[nodiscard]] AccelStats stats() const override;

  private:
    struct Locked;
    std::unique_ptr<Locked> locked_;
};

} // namespace plumb
