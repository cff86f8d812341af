/// \file  What a program without a device says.

#include "cuda/cuda_render.h"

#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(CudaRender, WithoutADeviceItSaysWhyInOneLine) {
    std::string why;
    if (cuda_available(&why))
        GTEST_SKIP() << "there is a device";
    EXPECT_EQ(why.rfind("cuda: ", 0), 0u) << why;
    EXPECT_GT(why.size(), 10u);
    EXPECT_EQ(why.find('\n'), std::string::npos);
    EXPECT_FALSE(cuda_available());
}

TEST(CudaRender, WithoutADeviceItThrowsTheSame) {
    std::string why;
    if (cuda_available(&why))
        GTEST_SKIP() << "there is a device";
    RenderStats stats;
    try {
        static_cast<void>(render_on_cuda({}, {}, {}, TriangleTest::watertight, {}, {}, stats));
        FAIL() << "rendered";
    } catch (const DeviceError& error) {
        EXPECT_EQ(error.what(), why);
    }
}

} // namespace
} // namespace plumb
