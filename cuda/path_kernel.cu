/// \file  The path tracer as CUDA kernels, one a profile and triangle test: a thread a pixel.
///
/// Only device code may come of the headers here: on the host, under nvcc, they would compile to
/// other code than in the rest of the program.

#include "cuda/path_kernel.h"

#include "cuda/cuda_check.h"

namespace plumb {
namespace {

constexpr std::uint32_t threads_per_block = 128;

// The job is a parameter of 2.5 kB in constant memory; __grid_constant__ saves the copy a thread
// that its address would cost. nvcc 13 cannot name a template argument of class type (Features) on
// the host, hence the bool.
template <bool Box, TriangleTest Test>
__global__ void __launch_bounds__(threads_per_block)
    render_kernel(const __grid_constant__ DeviceJob device) {
    constexpr Features features = Box ? box_profile : full_profile;
    render_thread<features, Test>(device, GridPosition{blockIdx.x, threadIdx.x, blockDim.x});
}
static_assert(sizeof(DeviceJob) <= 4096, "the limit of a kernel's parameters");

using Kernel = void (*)(DeviceJob);

Kernel kernel_of(PathKernel kind) {
    switch (kind) {
    case PathKernel::box: return render_kernel<true, TriangleTest::watertight>;
    case PathKernel::full: return render_kernel<false, TriangleTest::watertight>;
    case PathKernel::full_moeller_trumbore:
        return render_kernel<false, TriangleTest::moeller_trumbore>;
    }
    return nullptr;
}

} // namespace

void launch_path_kernel(const DeviceJob& device, PathKernel kind) {
    const Kernel kernel = kernel_of(kind);
    const LaunchShape shape = shape_for(device.batch.pixel_count, threads_per_block);
    kernel<<<shape.blocks, shape.block_size>>>(device);
    RT_CUDA_CHECK(cudaGetLastError());
}

void check_path_kernel() {
    cudaFuncAttributes attributes;
    RT_CUDA_CHECK(cudaFuncGetAttributes(&attributes, kernel_of(PathKernel::box)));
}

} // namespace plumb
