/// \file  Turns the error codes of the CUDA runtime into exceptions.
#pragma once

#include "cuda/device_error.h"

#include <cuda_runtime_api.h>
#include <string>

namespace plumb::detail {

/// Throws DeviceError unless `error` is success. Errors of a kernel surface at a later call: the
/// place is where it was noticed. The runtime forgets the error, so that one that was caught, no
/// memory say, does not fail the next launch.
inline void check_cuda(cudaError_t error, const char* file, int line) {
    if (error == cudaSuccess)
        return;
    cudaGetLastError();
    throw DeviceError(std::string("cuda: ") + cudaGetErrorString(error) + " (" + file + ":" +
                      std::to_string(line) + ")");
}

} // namespace plumb::detail

#define RT_CUDA_CHECK(call) ::plumb::detail::check_cuda(call, __FILE__, __LINE__)
