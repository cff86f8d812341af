/// \file  What a build without CUDA has in place of cuda_render.cpp and the kernels.

#include "cuda/cuda_render.h"
#include "cuda/ray_side.h"

namespace plumb {
namespace {

constexpr const char* built_without = "cuda: this program was built without CUDA";

} // namespace

bool cuda_available(std::string* why) {
    if (why != nullptr)
        *why = built_without;
    return false;
}

std::string cuda_device_name() { throw DeviceError(built_without); }

Film render_on_cuda(const RenderJob& /*job*/, const Features& /*needed*/,
                    const TreeViews& /*trees*/, TriangleTest /*test*/,
                    const CudaSettings& /*settings*/, const RenderOptions& /*options*/,
                    RenderStats& /*stats*/, DeviceReport* /*report*/) {
    throw DeviceError(built_without);
}

std::unique_ptr<RayTracer::Side> make_device_side(const TreeViews& /*trees*/, CudaTree /*tree*/,
                                                  TriangleTest /*test*/) {
    throw DeviceError(built_without);
}

} // namespace plumb
