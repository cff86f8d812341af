/// \file  The one exception of the GPU renderer.
#pragma once

#include <stdexcept>

namespace plumb {

/// No device, a driver that does not fit, out of device memory, a kernel that failed. what() is one
/// line that begins with "cuda: ".
class DeviceError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

} // namespace plumb
