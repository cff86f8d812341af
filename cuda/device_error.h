/// \file  The exceptions of the GPU renderer.
#pragma once

#include <stdexcept>

namespace plumb {

/// No device, a driver that does not fit, out of device memory, a kernel that failed. what() is one
/// line that begins with "cuda: ".
class DeviceError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// There is no GPU, or no driver for one, or the program was built without CUDA: nothing is wrong
/// with the machine. Tests skip where they meet this, and only then.
class NoDeviceError : public DeviceError {
  public:
    using DeviceError::DeviceError;
};

} // namespace plumb
