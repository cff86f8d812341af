/// \file  What a render on a device took of it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace plumb {

/// One kernel, as the runtime tells.
struct KernelReport {
    std::string name;
    int registers = 0;           ///< a thread
    std::size_t local_bytes = 0; ///< a thread: stacks and what was spilled
    int threads_per_block = 0, blocks_per_multiprocessor = 0;
    double occupancy = 0; ///< share of the threads that a multiprocessor can hold
};

struct DeviceReport {
    std::string device;            ///< its name
    double upload_s = 0;           ///< allocation and copies of scene and tree
    std::size_t scene_bytes = 0;   ///< of them
    std::size_t working_bytes = 0; ///< film, counters, waves
    std::vector<KernelReport> kernels;
};

} // namespace plumb
