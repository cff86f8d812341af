#include "cuda/device.h"

#include "cuda/cuda_check.h"
#include "cuda/path_kernel.h"

namespace plumb {

void start_device() {
    int driver = 0;
    if (cudaDriverGetVersion(&driver) == cudaSuccess && driver == 0)
        throw NoDeviceError("cuda: there is no NVIDIA driver");
    int devices = 0;
    const cudaError_t counted = cudaGetDeviceCount(&devices);
    if (counted == cudaErrorNoDevice || (counted == cudaSuccess && devices == 0)) {
        cudaGetLastError(); // forgets it
        throw NoDeviceError("cuda: there is no CUDA-capable GPU");
    }
    RT_CUDA_CHECK(counted);
    RT_CUDA_CHECK(cudaSetDevice(0));
    check_path_kernel();
}

std::string device_name() {
    cudaDeviceProp properties;
    RT_CUDA_CHECK(cudaGetDeviceProperties(&properties, 0));
    return properties.name;
}

void require_device_memory(std::size_t bytes, const char* what) {
    std::size_t free = 0, total = 0;
    RT_CUDA_CHECK(cudaMemGetInfo(&free, &total));
    if (bytes <= free)
        return;
    const auto mebibytes = [](std::size_t n) { return std::to_string((n >> 20) + 1) + " MiB"; };
    throw DeviceError(std::string("cuda: ") + what + " takes " + mebibytes(bytes) +
                      " and the device has " + mebibytes(free) + " free of " + mebibytes(total));
}

} // namespace plumb
