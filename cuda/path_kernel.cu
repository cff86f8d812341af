/// \file  The path tracer as CUDA kernels, one a profile, triangle test and tree: a thread a
/// sample.
///
/// Only device code may come of the headers here: on the host, under nvcc, they would compile to
/// other code than in the rest of the program.

#include "cuda/launch.cuh"

namespace plumb {
namespace {

// The job is a parameter of 2.5 kB in constant memory; __grid_constant__ saves the copy a thread
// that its address would cost. nvcc 13 cannot name a template argument of class type (Features) on
// the host, hence the bool.
template <bool Box, TriangleTest Test, CudaTree Tree>
__global__ void __launch_bounds__(threads_per_block)
    render_kernel(const __grid_constant__ DeviceJob device) {
    constexpr Features features = Box ? box_profile : full_profile;
    render_thread<features, Test, Tree>(device, GridPosition{blockIdx.x, threadIdx.x, blockDim.x});
}

__global__ void __launch_bounds__(threads_per_block)
    add_samples_kernel(const __grid_constant__ DeviceJob device) {
    add_samples_thread(device, GridPosition{blockIdx.x, threadIdx.x, blockDim.x});
}
static_assert(sizeof(DeviceJob) <= 4096, "the limit of a kernel's parameters");

using Kernel = void (*)(DeviceJob);

template <CudaTree Tree> Kernel kernel_of(PathKernel kind) {
    switch (kind) {
    case PathKernel::box: return render_kernel<true, TriangleTest::watertight, Tree>;
    case PathKernel::full: return render_kernel<false, TriangleTest::watertight, Tree>;
    case PathKernel::full_moeller_trumbore:
        return render_kernel<false, TriangleTest::moeller_trumbore, Tree>;
    }
    return nullptr;
}

Kernel kernel_of(PathKernel kind, CudaTree tree) {
    return tree == CudaTree::binary ? kernel_of<CudaTree::binary>(kind)
                                    : kernel_of<CudaTree::wide>(kind);
}

} // namespace

void launch_path_kernel(const DeviceJob& device, PathKernel kind, CudaTree tree) {
    const auto launch = [&](Kernel kernel, std::uint32_t items) {
        const LaunchShape shape = shape_for(items, threads_per_block);
        kernel<<<shape.blocks, shape.block_size>>>(device);
        RT_CUDA_CHECK(cudaGetLastError());
    };
    launch(kernel_of(kind, tree), device.batch.slots());
    launch(add_samples_kernel, device.batch.pixel_count);
}

void check_path_kernel() {
    cudaFuncAttributes attributes;
    RT_CUDA_CHECK(cudaFuncGetAttributes(&attributes, kernel_of(PathKernel::box, CudaTree::binary)));
}

std::vector<KernelReport> path_kernel_reports(PathKernel kind, CudaTree tree) {
    return {report_of(reinterpret_cast<const void*>(kernel_of(kind, tree)), "megakernel")};
}

} // namespace plumb
