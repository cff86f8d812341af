/// \file  What a build without CUDA has in place of cuda_render.cpp.

#include "cuda/cuda_render.h"

namespace plumb {
namespace {

constexpr const char* built_without = "cuda: this program was built without CUDA";

} // namespace

bool cuda_available(std::string* why) {
    if (why != nullptr)
        *why = built_without;
    return false;
}

Film render_on_cuda(const RenderJob& /*job*/, const Features& /*needed*/, const SahView& /*tree*/,
                    TriangleTest /*test*/, const RenderOptions& /*options*/,
                    RenderStats& /*stats*/) {
    throw DeviceError(built_without);
}

} // namespace plumb
