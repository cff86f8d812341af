#include "cuda/device_rays.h"

#include "cuda/device.h"
#include "cuda/device_buffer.h"
#include "cuda/place_scene.h"
#include "cuda/ray_launch.h"

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

} // namespace

struct DeviceRays::State {
    CudaTree tree;
    TriangleTest test;
    RayJob job{};
    std::optional<DeviceBuffer<std::byte>> block{};
    std::optional<DeviceBuffer<Ray>> rays{};
    std::optional<DeviceBuffer<Hit>> hits{};
    std::optional<DeviceBuffer<std::uint8_t>> found{};
    std::optional<DeviceBuffer<std::uint32_t>> taken{};
    std::optional<KernelClock> clock{};
};

DeviceRays::DeviceRays(const TreeViews& trees, CudaTree tree, TriangleTest test)
    : state_(new State{tree, test}) {
    start_device();
    Arena measure;
    static_cast<void>(place(trees, measure));
    require_device_memory(measure.used(), "the tree");
    state_->block.emplace(measure.used());
    Arena arena(state_->block->data(), [](std::byte* to, const void* from, std::size_t bytes) {
        RT_CUDA_CHECK(cudaMemcpy(to, from, bytes, cudaMemcpyHostToDevice));
    });
    state_->job.trees = place(trees, arena);
    state_->taken.emplace(1);
    state_->job.taken = state_->taken->data();
}

DeviceRays::~DeviceRays() = default;

void DeviceRays::load(std::span<const Ray> rays) {
    RT_CUDA_CHECK(cudaSetDevice(0)); // of this thread
    State& s = *state_;
    s.job.count = 0;                                 // if memory does not suffice
    if (!s.found || s.found->size() < rays.size()) { // the last of the three: all are there
        s.found.reset();
        s.rays.emplace(rays.size());
        s.hits.emplace(rays.size());
        s.found.emplace(rays.size());
    }
    s.rays->copy_from(rays);
    s.job.rays = s.rays->data();
    s.job.count = rays.size();
    s.job.hits = s.hits->data();
    s.job.found = s.found->data();
}

double DeviceRays::trace(bool any_hit, RayThreads threads) {
    State& s = *state_;
    if (!s.clock)
        s.clock.emplace();
    if (s.job.count > 0) { // a ray that is lost must not find the answer of the last trace
        s.hits->fill(0xff);
        s.found->fill(0xff);
    }
    s.taken->clear(1);
    s.clock->begin();
    if (threads == RayThreads::persistent)
        launch_rays_persistently(s.job, s.test);
    else
        launch_rays(s.job, s.tree, s.test, any_hit);
    return s.clock->end();
}

void DeviceRays::fetch(std::span<Hit> hits) const { state_->hits->copy_to(hits); }
void DeviceRays::fetch(std::span<std::uint8_t> found) const { state_->found->copy_to(found); }

std::vector<KernelReport> DeviceRays::kernels(bool any_hit, RayThreads threads) const {
    return {threads == RayThreads::persistent
                ? persistent_kernel_report(state_->test)
                : ray_kernel_report(state_->tree, state_->test, any_hit)};
}

} // namespace plumb
