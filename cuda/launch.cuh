/// \file  What the .cu files share: the block size and what a kernel takes of the device.
#pragma once

#include "cuda/cuda_check.h"
#include "cuda/path_kernel.h"

namespace plumb {
namespace {

constexpr std::uint32_t threads_per_block = 128;

/// Blocks of ray kernels on a multiprocessor at a time. ptxas finds registers for so many if asked;
/// unasked, closest hits in the wide tree take 83 each, with which there are five blocks.
constexpr int closest_blocks = 6;
template <CudaTree Tree> constexpr int any_hit_blocks = Tree == CudaTree::binary ? 8 : 7;

/// Registers and occupancy of a kernel on the current device.
inline KernelReport report_of(const void* kernel, const char* name) {
    cudaFuncAttributes attributes;
    RT_CUDA_CHECK(cudaFuncGetAttributes(&attributes, kernel));
    int device = 0, most = 0, blocks = 0;
    RT_CUDA_CHECK(cudaGetDevice(&device));
    RT_CUDA_CHECK(cudaDeviceGetAttribute(&most, cudaDevAttrMaxThreadsPerMultiProcessor, device));
    RT_CUDA_CHECK(cudaOccupancyMaxActiveBlocksPerMultiprocessor(
        &blocks, kernel, static_cast<int>(threads_per_block), 0));
    KernelReport report;
    report.name = name;
    report.registers = attributes.numRegs;
    report.local_bytes = attributes.localSizeBytes;
    report.threads_per_block = static_cast<int>(threads_per_block);
    report.blocks_per_multiprocessor = blocks;
    report.occupancy = static_cast<double>(blocks) * threads_per_block / most;
    return report;
}

} // namespace
} // namespace plumb
