/// \file  What the model takes of a GPU and of the kernels, and where the numbers come from.
#pragma once

#include <cstdint>

namespace plumb::warps {

/// An H100 SXM. Rates are of one multiprocessor and a clock.
struct Gpu {
    int multiprocessors = 132;   ///< data sheet
    double clock_hz = 1.755e9;   ///< boost clock, data sheet of the PCIe card
    double instructions = 4;     ///< of warps: four schedulers (Hopper tuning guide)
    double alu_instructions = 2; ///< of warps: 64 lanes compare, select, shift, ... (CUDA
                                 ///< programming guide, arithmetic throughput, 9.0)
    double tag_lines = 4;        ///< lines of 128 bytes that the L1 looks up (NVIDIA's forum,
                                 ///< "Understanding L1/TEX Cache Sectors/Req", of Volta and later)
    double data_bytes = 128;     ///< that the L1 hands out
    /// 2544 GB/s of a V100's 80 multiprocessors at 1.38 GHz (gpu-benches, cuda-cache), for want of
    /// an H100's.
    double l2_bytes = 23;
    double memory_bytes = 3.35e12 / 132 / 1.755e9; ///< data sheet
    std::uint32_t l1_size = 192u << 10;       ///< of 256 KiB: the rest for stacks in local memory
    double l1_latency = 33, l2_latency = 214; ///< clocks; V100 (gpu-benches, cuda-latency)
    double instruction_latency = 2; ///< 4 clocks, two instructions of a warp at a time: assumed
    std::uint32_t registers = 65536;

    static constexpr std::uint32_t lanes = 32, warps_of_block = 4, most_warps = 64;
};

/// Instructions of a part of a kernel.
struct Cost {
    std::uint32_t all = 0;
    std::uint32_t alu = 0; ///< of these on the ALU
};

/// Counted in the machine code of ray_kernel.cu and wave_kernel.cu for sm_90 (nvcc 13.0, cuobjdump
/// -sass), along the way that most lanes take.
struct Costs {
    Cost ray{200, 90};         ///< checks and prepares it, stores its hit
    Cost binary_node{110, 60}; ///< with what comes from the stack
    Cost wide_node{300, 175};  ///< likewise
    Cost triangle{120, 55};    ///< 89 for a miss, 310 for a hit
    Cost sphere{230, 40};      ///< in double precision
    Cost shade{3000, 950};     ///< a vertex and its light: half of the box profile's shade stage
};

} // namespace plumb::warps
