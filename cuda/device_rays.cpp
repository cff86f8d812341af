/// \file  Batches of rays on the device: RayTracer's other side.

#include "cuda/device.h"
#include "cuda/device_buffer.h"
#include "cuda/place_scene.h"
#include "cuda/ray_launch.h"
#include "cuda/ray_side.h"

#include <optional>

namespace plumb {
namespace {

/// Two events around a kernel.
class KernelClock {
  public:
    KernelClock() {
        RT_CUDA_CHECK(cudaEventCreate(&begin_));
        RT_CUDA_CHECK(cudaEventCreate(&end_));
    }
    KernelClock(const KernelClock&) = delete;
    KernelClock& operator=(const KernelClock&) = delete;
    ~KernelClock() {
        cudaEventDestroy(begin_);
        cudaEventDestroy(end_);
    }
    void begin() { RT_CUDA_CHECK(cudaEventRecord(begin_)); }
    /// Waits. Seconds since begin().
    double end() {
        RT_CUDA_CHECK(cudaEventRecord(end_));
        RT_CUDA_CHECK(cudaEventSynchronize(end_));
        float milliseconds = 0;
        RT_CUDA_CHECK(cudaEventElapsedTime(&milliseconds, begin_, end_));
        return 1e-3 * static_cast<double>(milliseconds);
    }

  private:
    cudaEvent_t begin_ = nullptr, end_ = nullptr;
};

class DeviceSide final : public RayTracer::Side {
  public:
    DeviceSide(const TreeViews& trees, CudaTree tree, TriangleTest test)
        : tree_(tree), test_(test) {
        start_device();
        Arena measure;
        static_cast<void>(place(trees, measure));
        require_device_memory(measure.used(), "the tree");
        block_.emplace(measure.used());
        Arena arena(block_->data(), [](std::byte* to, const void* from, std::size_t bytes) {
            RT_CUDA_CHECK(cudaMemcpy(to, from, bytes, cudaMemcpyHostToDevice));
        });
        job_.trees = place(trees, arena);
    }

    void load(std::span<const Ray> rays) override {
        RT_CUDA_CHECK(cudaSetDevice(0)); // of this thread
        if (!rays_ || rays_->size() < rays.size()) {
            rays_.emplace(rays.size());
            hits_.emplace(rays.size());
            found_.emplace(rays.size());
        }
        rays_->copy_from(rays);
        job_.rays = rays_->data();
        job_.count = rays.size();
        job_.hits = hits_->data();
        job_.found = found_->data();
    }
    double trace(bool any_hit) override {
        if (!clock_)
            clock_.emplace();
        clock_->begin();
        launch_rays(job_, tree_, test_, any_hit);
        return clock_->end();
    }
    void fetch(std::span<Hit> hits) const override { hits_->copy_to(hits); }
    void fetch(std::span<std::uint8_t> found) const override { found_->copy_to(found); }
    [[nodiscard]] std::vector<KernelReport> kernels(bool any_hit) const override {
        return {ray_kernel_report(tree_, test_, any_hit)};
    }

  private:
    CudaTree tree_;
    TriangleTest test_;
    RayJob job_;
    std::optional<DeviceBuffer<std::byte>> block_;
    std::optional<DeviceBuffer<Ray>> rays_;
    std::optional<DeviceBuffer<Hit>> hits_;
    std::optional<DeviceBuffer<std::uint8_t>> found_;
    std::optional<KernelClock> clock_;
};

} // namespace

std::unique_ptr<RayTracer::Side> make_device_side(const TreeViews& trees, CudaTree tree,
                                                  TriangleTest test) {
    return std::make_unique<DeviceSide>(trees, tree, test);
}

} // namespace plumb
