/// \file  Ray queries alone as CUDA kernels. See path_kernel.cu for what holds here.

#include "cuda/device_warp.cuh"
#include "cuda/ray_launch.h"

namespace plumb {
namespace {

template <TriangleTest Test, CudaTree Tree, bool AnyHit>
__global__ void __launch_bounds__(threads_per_block, AnyHit ? any_hit_blocks<Tree> : closest_blocks)
    trace_kernel(const __grid_constant__ RayJob job) {
    trace_ray_thread<Test, Tree, AnyHit>(job, GridPosition{blockIdx.x, threadIdx.x, blockDim.x});
}

template <TriangleTest Test>
__global__ void __launch_bounds__(threads_per_block)
    trace_persistently_kernel(const __grid_constant__ RayJob job) {
    trace_persistently_on_device<Test>(job.trees.wide, RayItems{job}, *job.taken);
}

using Kernel = void (*)(RayJob);

template <TriangleTest Test, CudaTree Tree> Kernel kernel_of(bool any_hit) {
    return any_hit ? trace_kernel<Test, Tree, true> : trace_kernel<Test, Tree, false>;
}

template <TriangleTest Test> Kernel kernel_of(CudaTree tree, bool any_hit) {
    return tree == CudaTree::binary ? kernel_of<Test, CudaTree::binary>(any_hit)
                                    : kernel_of<Test, CudaTree::wide>(any_hit);
}

Kernel kernel_of(CudaTree tree, TriangleTest test, bool any_hit) {
    return test == TriangleTest::watertight
               ? kernel_of<TriangleTest::watertight>(tree, any_hit)
               : kernel_of<TriangleTest::moeller_trumbore>(tree, any_hit);
}

Kernel persistent_kernel_of(TriangleTest test) {
    return test == TriangleTest::watertight
               ? trace_persistently_kernel<TriangleTest::watertight>
               : trace_persistently_kernel<TriangleTest::moeller_trumbore>;
}

} // namespace

void launch_rays(const RayJob& job, CudaTree tree, TriangleTest test, bool any_hit) {
    if (job.count == 0)
        return;
    const LaunchShape shape = shape_for(job.count, threads_per_block);
    kernel_of(tree, test, any_hit)<<<shape.blocks, shape.block_size>>>(job);
    RT_CUDA_CHECK(cudaGetLastError());
}

void launch_rays_persistently(const RayJob& job, TriangleTest test) {
    if (job.count == 0)
        return;
    const Kernel kernel = persistent_kernel_of(test);
    const LaunchShape shape = persistent_shape(reinterpret_cast<const void*>(kernel), job.count);
    kernel<<<shape.blocks, shape.block_size>>>(job);
    RT_CUDA_CHECK(cudaGetLastError());
}

KernelReport ray_kernel_report(CudaTree tree, TriangleTest test, bool any_hit) {
    return report_of(reinterpret_cast<const void*>(kernel_of(tree, test, any_hit)),
                     any_hit ? "any-hit rays" : "closest-hit rays");
}

KernelReport persistent_kernel_report(TriangleTest test) {
    return report_of(reinterpret_cast<const void*>(persistent_kernel_of(test)),
                     "closest-hit rays, persistent threads");
}

} // namespace plumb
