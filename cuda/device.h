/// \file  The first device: starting it, its name and its memory.
#pragma once

#include <cstddef>
#include <string>

namespace plumb {

/// Makes the first device current. Throws DeviceError if it cannot run the kernels.
void start_device();

[[nodiscard]] std::string device_name();

/// Throws DeviceError, which names both sizes, where `bytes` more do not fit into the device's free
/// memory. `what` begins the sentence: "the scene".
void require_device_memory(std::size_t bytes, const char* what);

} // namespace plumb
