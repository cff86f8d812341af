/// \file  The stages of the wavefront as CUDA kernels. See path_kernel.cu for what holds here.

#include "cuda/device_warp.cuh"

namespace plumb {
namespace {

__device__ GridPosition position() { return {blockIdx.x, threadIdx.x, blockDim.x}; }

template <bool Box>
__global__ void __launch_bounds__(threads_per_block)
    generate_kernel(const __grid_constant__ WaveJob job) {
    constexpr Features features = Box ? box_profile : full_profile;
    generate_thread<features>(job, position());
}

template <TriangleTest Test, CudaTree Tree>
__global__ void __launch_bounds__(threads_per_block, closest_blocks)
    extend_kernel(const __grid_constant__ WaveJob job) {
    extend_thread<Test, Tree>(job, position());
}

template <TriangleTest Test>
__global__ void __launch_bounds__(threads_per_block)
    extend_persistently_kernel(const __grid_constant__ WaveJob job) {
    trace_persistently_on_device<Test>(job.device.trees.wide, ExtendItems{job}, job.filled().taken);
}

template <bool Box>
__global__ void __launch_bounds__(threads_per_block)
    shade_kernel(const __grid_constant__ WaveJob job) {
    constexpr Features features = Box ? box_profile : full_profile;
    shade_thread<features>(job, position());
}

template <TriangleTest Test, CudaTree Tree>
__global__ void __launch_bounds__(threads_per_block, any_hit_blocks<Tree>)
    shadow_kernel(const __grid_constant__ WaveJob job) {
    shadow_thread<Test, Tree>(job, position());
}

__global__ void __launch_bounds__(threads_per_block)
    accumulate_kernel(const __grid_constant__ WaveJob job) {
    accumulate_thread(job, position());
}
static_assert(sizeof(WaveJob) <= 4096, "the limit of a kernel's parameters");

using Kernel = void (*)(WaveJob);

struct Stages {
    Kernel generate, extend, extend_persistently, shade, shadow, accumulate;
};

/// None for the binary tree.
template <TriangleTest Test, CudaTree Tree> Kernel persistent_kernel() {
    if constexpr (Tree == CudaTree::wide)
        return extend_persistently_kernel<Test>;
    return nullptr;
}

template <CudaTree Tree> Stages stages_of(PathKernel kind) {
    constexpr TriangleTest watertight = TriangleTest::watertight;
    constexpr TriangleTest moeller_trumbore = TriangleTest::moeller_trumbore;
    if (kind == PathKernel::full_moeller_trumbore)
        return {generate_kernel<false>,
                extend_kernel<moeller_trumbore, Tree>,
                persistent_kernel<moeller_trumbore, Tree>(),
                shade_kernel<false>,
                shadow_kernel<moeller_trumbore, Tree>,
                accumulate_kernel};
    const bool box = kind == PathKernel::box;
    return {box ? generate_kernel<true> : generate_kernel<false>,
            extend_kernel<watertight, Tree>,
            persistent_kernel<watertight, Tree>(),
            box ? shade_kernel<true> : shade_kernel<false>,
            shadow_kernel<watertight, Tree>,
            accumulate_kernel};
}

Stages stages_of(PathKernel kind, CudaTree tree) {
    return tree == CudaTree::binary ? stages_of<CudaTree::binary>(kind)
                                    : stages_of<CudaTree::wide>(kind);
}

Kernel kernel_of(const Stages& stages, WaveStage stage) {
    switch (stage) {
    case WaveStage::generate: return stages.generate;
    case WaveStage::extend: return stages.extend;
    case WaveStage::extend_persistently: return stages.extend_persistently;
    case WaveStage::shade: return stages.shade;
    case WaveStage::shadow: return stages.shadow;
    case WaveStage::accumulate: return stages.accumulate;
    }
    return nullptr;
}

} // namespace

void launch_wave_stage(WaveStage stage, const WaveJob& job, PathKernel kind, CudaTree tree) {
    const Kernel kernel = kernel_of(stages_of(kind, tree), stage);
    const LaunchShape shape =
        stage == WaveStage::extend_persistently
            ? persistent_shape(reinterpret_cast<const void*>(kernel), job.threads)
            : shape_for(job.threads, threads_per_block);
    kernel<<<shape.blocks, shape.block_size>>>(job);
    RT_CUDA_CHECK(cudaGetLastError());
}

std::vector<KernelReport> wave_kernel_reports(PathKernel kind, const CudaSettings& settings) {
    const Stages stages = stages_of(kind, settings.tree);
    const auto report = [](Kernel kernel, const char* name) {
        return report_of(reinterpret_cast<const void*>(kernel), name);
    };
    std::vector<KernelReport> reports{
        report(stages.generate, "generate"), report(stages.extend, "extend"),
        report(stages.shade, "shade"), report(stages.shadow, "shadow"),
        report(stages.accumulate, "accumulate")};
    if (settings.schedule == CudaSchedule::persistent)
        reports.push_back(report(stages.extend_persistently, "extend persistently"));
    return reports;
}

} // namespace plumb
