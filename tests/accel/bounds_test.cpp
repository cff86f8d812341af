/// \file  Boxes and the slab test: the rows of the stability table that concern them.

#include "accel/math/bounds.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace plumb::test {
namespace {

bool enters(const Bounds& box, const Ray& ray) {
    return overlaps(slab_interval(SlabRay(ray), box), ray.tmin, ray.tmax);
}

Vec3 direction_to(const Vec3& target, const Vec3& origin) { return target - origin; }

TEST(BuildFlags, ProductsRoundBeforeTheyAreSubtracted) {
    // x*x rounded, minus itself: 0. With contraction to FMA the rounding error of x*x is left.
    volatile float x = 1.0f + 0x1p-12f;
    const float a = x;
    volatile float square = a * a;
    const float b = x; // read again, or the compiler reuses the product
    const float difference = b * b - square;
    EXPECT_EQ(difference, 0.0f);
}

TEST(BuildFlags, InfinitiesAndNansAreHonoured) {
#ifdef __FAST_MATH__
    FAIL() << "-ffast-math loses 41.5 % of the slab test's hits";
#endif
    volatile float zero = 0;
    const float product = zero * infinity;
    EXPECT_FALSE(product == product);
    EXPECT_TRUE(std::signbit(-zero));
}

TEST(Bounds, AnEmptyBoxIsTheNeutralElementOfExtend) {
    Bounds box;
    EXPECT_TRUE(box.empty());
    EXPECT_EQ(surface_area(box), 0);
    box.extend(Vec3{1, 2, 3});
    EXPECT_FALSE(box.empty());
    EXPECT_EQ(box.lower, (Vec3{1, 2, 3}));
    EXPECT_EQ(box.upper, (Vec3{1, 2, 3}));
    box.extend(Bounds{});
    EXPECT_EQ(box.upper, (Vec3{1, 2, 3}));
    box.extend(Bounds{{-1, 0, 5}, {0, 4, 6}});
    EXPECT_EQ(box.lower, (Vec3{-1, 0, 3}));
    EXPECT_EQ(box.upper, (Vec3{1, 4, 6}));
    EXPECT_TRUE(box.contains(Bounds{{0, 1, 4}, {1, 2, 5}}));
    EXPECT_FALSE(box.contains(Bounds{{0, 1, 4}, {1.5f, 2, 5}}));
}

TEST(Bounds, SurfaceAreaAndCenterDoNotOverflowAtTheLargestCoordinates) {
    EXPECT_DOUBLE_EQ(surface_area(Bounds{{0, 0, 0}, {1, 2, 3}}), 22); // 2 (2 + 6 + 3)
    const float m = max_coordinate;
    const Bounds all{{-m, -m, -m}, {m, m, m}};
    const double edge = 2 * static_cast<double>(m);
    EXPECT_DOUBLE_EQ(surface_area(all), 6 * edge * edge);
    EXPECT_EQ(all.center(), (Vec3{0, 0, 0}));
}

TEST(SlabTest, KeepsRaysThatStartOnASlabPlaneAndRunAlongIt) {
    // Closed box: a ray along one of its planes meets it wherever the other axes do. 0 * inf is
    // where std::min/max lose half of these rays.
    Random random(11);
    int missed = 0;
    for (int i = 0; i < 60000; ++i) {
        const Vec3 lower = random.point(-10, 10);
        const Bounds box{lower, lower + random.point(0.1f, 5)};
        const int zero_axis = i % 3, other = (zero_axis + 1) % 3, third = (zero_axis + 2) % 3;
        Vec3 target, direction;
        target[zero_axis] = i % 2 == 0 ? box.lower[zero_axis] : box.upper[zero_axis];
        for (const int axis : {other, third})
            target[axis] =
                random.uniform(0.4f, 0.6f) * (box.upper[axis] - box.lower[axis]) + box.lower[axis];
        direction[other] = random.uniform(-1, 1);
        direction[third] = i % 5 == 0 ? 0.0f : random.uniform(-1, 1);
        direction[zero_axis] = i % 4 < 2 ? 0.0f : -0.0f;
        Vec3 origin = target - 30.0f * direction;
        origin[zero_axis] = target[zero_axis];
        missed += !enters(box, Ray{origin, 0, direction, infinity});
    }
    EXPECT_EQ(missed, 0);
}

/// Missed rays of those aimed at an edge or a corner of boxes with one flat or thin axis.
int missed_thin_boxes(float offset, std::uint64_t seed) {
    Random random(seed);
    int missed = 0;
    for (int i = 0; i < 200000; ++i) {
        const Vec3 base{offset, -offset, 0.5f * offset};
        const Vec3 lower = base + random.point(-10, 10);
        Vec3 size = random.point(0.1f, 5);
        const std::array thin{0.0f, 1e-6f, 1e-3f};
        size[i % 3] = thin[random.index(3)];
        const Bounds box{lower, lower + size};
        const std::uint32_t corner = random.index(8);
        Vec3 target{(corner & 1u) != 0 ? box.upper.x : box.lower.x,
                    (corner & 2u) != 0 ? box.upper.y : box.lower.y,
                    (corner & 4u) != 0 ? box.upper.z : box.lower.z};
        if (i % 2 == 0) { // anywhere on an edge instead
            const int axis = static_cast<int>(random.index(3));
            target[axis] = clamp(random.uniform(box.lower[axis], box.upper[axis]), box.lower[axis],
                                 box.upper[axis]);
        }
        const Vec3 origin = base + random.point(-50, 50);
        Vec3 direction = direction_to(target, origin);
        if (i % 4 < 2)
            direction = normalize(direction);
        missed += !enters(box, Ray{origin, 0, direction, infinity});
    }
    return missed;
}

TEST(SlabTest, LosesNoRayAimedAtTheEdgesOfThinBoxes) {
    EXPECT_EQ(missed_thin_boxes(0, 12), 0);
    EXPECT_EQ(missed_thin_boxes(100, 13), 0);
}

TEST(SlabTest, LosesNoRayAimedAtTheEdgesOfThinBoxesAtOffsetAMillion) {
    EXPECT_EQ(missed_thin_boxes(1e6f, 14), 0);
}

TEST(SlabTest, RefusesBoxesThatARayClearlyMisses) {
    // A target 1 % of the box beyond a face, aimed along the face's own plane directions.
    const Bounds box{{-1, -1, -1}, {1, 1, 1}};
    Random random(15);
    for (int i = 0; i < 1000; ++i) {
        const float x = random.uniform(-1, 1);
        EXPECT_FALSE(enters(box, Ray{{x, 1.01f, -5}, 0, {0, 0, 1}, infinity}));
        EXPECT_FALSE(enters(box, Ray{{x, 0, -5}, 0, {0, 0, -1}, infinity})); // behind
        EXPECT_FALSE(enters(box, Ray{{x, 0, -5}, 0, {0, 0, 1}, 3.99f}));     // ends before
        EXPECT_FALSE(enters(box, Ray{{x, 0, -5}, 6.01f, {0, 0, 1}, infinity}));
        EXPECT_TRUE(enters(box, Ray{{x, 0, -5}, 0, {0, 0, 1}, 4.0f}));
    }
    EXPECT_FALSE(enters(Bounds{}, Ray{{0, 0, -5}, 0, {0, 0, 1}, infinity}));
}

TEST(SlabTest, IsMonotoneSoThatNoTreeCullsAHit) {
    Random random(16);
    int broken = 0;
    for (int i = 0; i < 200000; ++i) {
        const float scale = std::ldexp(1.0f, static_cast<int>(random.index(40)) - 20);
        const Vec3 lower = scale * random.point(-1, 1);
        const Bounds inner{lower, lower + scale * random.point(0, 1)};
        Bounds outer = inner;
        outer.extend(scale * random.point(-2, 2));
        Vec3 direction = random.direction();
        if (i % 3 == 0)
            direction[i % 2] = 0;
        const SlabRay ray(Ray{scale * random.point(-3, 3), 0, direction, infinity});
        const Interval a = slab_interval(ray, inner), b = slab_interval(ray, outer);
        broken += !(b.near <= a.near && b.far >= a.far);
    }
    EXPECT_EQ(broken, 0);
}

TEST(SlabTest, ClampBetweenOrdersItsEndsAndKeepsNan) {
    EXPECT_EQ(clamp_between({1, 2}, 3), 2);
    EXPECT_EQ(clamp_between({2, 1}, 3), 2);
    EXPECT_EQ(clamp_between({2, 1}, 0), 1);
    EXPECT_EQ(clamp_between({1, 2}, 1.5f), 1.5f);
    EXPECT_TRUE(std::isnan(clamp_between({1, 2}, std::nanf(""))));
}

} // namespace
} // namespace plumb::test
