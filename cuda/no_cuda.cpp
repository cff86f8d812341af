/// \file  What a build without CUDA has in place of cuda_render.cpp and the kernels.

#include "cuda/cuda_render.h"
#include "cuda/device_rays.h"

namespace plumb {
namespace {

constexpr const char* built_without = "cuda: this program was built without CUDA";

} // namespace

bool cuda_available(std::string* why) {
    if (why != nullptr)
        *why = built_without;
    return false;
}

std::string cuda_device_name() { throw NoDeviceError(built_without); }

Film render_on_cuda(const RenderJob& /*job*/, const Features& /*needed*/,
                    const TreeViews& /*trees*/, TriangleTest /*test*/,
                    const CudaSettings& /*settings*/, const RenderOptions& /*options*/,
                    RenderStats& /*stats*/, DeviceReport* /*report*/) {
    throw NoDeviceError(built_without);
}

// There is never one.
struct DeviceRays::State {};
DeviceRays::DeviceRays(const TreeViews& /*trees*/, CudaTree /*tree*/, TriangleTest /*test*/) {
    throw NoDeviceError(built_without);
}
DeviceRays::~DeviceRays() = default;
void DeviceRays::load(std::span<const Ray> /*rays*/) {}
double DeviceRays::trace(bool /*any_hit*/, RayThreads /*threads*/) { return 0; }
void DeviceRays::fetch(std::span<Hit> /*hits*/) const {}
void DeviceRays::fetch(std::span<std::uint8_t> /*found*/) const {}
std::vector<KernelReport> DeviceRays::kernels(bool /*any_hit*/, RayThreads /*threads*/) const {
    return {};
}

} // namespace plumb
