/// \file  Packets cull the triangles of a leaf by the boxes that the triangle test settles in.
#ifdef __x86_64__
#include "accel/sah/isa/lanes_sse2.h"
#include "accel/sah/isa/packet_triangles.h"
#include "accel/triangle.h"
#include "tests/support/random.h"

#include <cmath>
#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(PacketBounds, AreThoseOfTheTriangleTestBitForBit) {
    test::Random random(7);
    for (int round = 0; round < 2000; ++round) {
        WideTriangles block{};
        // From slivers at the origin to small triangles far away, and walls along an axis.
        const float size = std::exp2(random.uniform(-20, 20)), offset = random.uniform(-1, 1);
        const float away = offset * std::exp2(random.uniform(-20, 20));
        for (auto& vertex : block.vertex)
            for (int axis = 0; axis < 3; ++axis)
                for (float& x : vertex[axis])
                    x = (axis == round % 4 ? 0 : size * random.uniform(-1, 1)) + away;
        alignas(64) float planes[3][2][wide_width];
        store_bounds<Lanes>(block, &planes[0][0][0]);
        for (int lane = 0; lane < wide_width; ++lane) {
            const Bounds expected = triangle_bounds(block.corner(0, lane), block.corner(1, lane),
                                                    block.corner(2, lane));
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_EQ(planes[axis][0][lane], expected.lower[axis]) << round;
                EXPECT_EQ(planes[axis][1][lane], expected.upper[axis]) << round;
            }
        }
    }
}

} // namespace
} // namespace plumb
#endif
