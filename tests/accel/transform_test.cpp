/// \file  Transforms against their defining properties.

#include "accel/math/transform.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace plumb::test {
namespace {

double distance(Vec3 a, Vec3 b) {
    return std::hypot(static_cast<double>(a.x) - static_cast<double>(b.x),
                      static_cast<double>(a.y) - static_cast<double>(b.y),
                      static_cast<double>(a.z) - static_cast<double>(b.z));
}

Transform random_transform(Random& random) {
    const auto number = [&] { return static_cast<double>(random.uniform(-3, 3)); };
    const auto factor = [&] { return static_cast<double>(random.uniform(0.2f, 4)); };
    const double tx = number(), ty = number(), tz = number();
    const double ax = number(), ay = number(), az = number(), angle = 60 * number();
    const double sx = factor(), sy = factor(), sz = factor();
    return Transform::translate(tx, ty, tz) * Transform::rotate(ax, ay, az, angle) *
           Transform::scale(sx, sy, sz);
}

TEST(Transform, ProductAppliesTheRightHandSideFirst) {
    const Transform both = Transform::translate(1, 0, 0) * Transform::scale(2, 3, 4);
    EXPECT_EQ(both.point({1, 1, 1}), (Vec3{3, 3, 4}));
    EXPECT_EQ(both.vector({1, 1, 1}), (Vec3{2, 3, 4}));
}

TEST(Transform, RotateTurnsCounterClockwise) {
    EXPECT_LT(distance(Transform::rotate(0, 0, 1, 90).vector({1, 0, 0}), {0, 1, 0}), 1e-7);
    EXPECT_LT(distance(Transform::rotate(0, 5, 0, 90).vector({0, 0, 1}), {1, 0, 0}), 1e-7);
    EXPECT_LT(distance(Transform::rotate(2, 0, 0, 90).vector({0, 1, 0}), {0, 0, 1}), 1e-7);
    // 120 degrees about (1,1,1) permutes the axes.
    EXPECT_LT(distance(Transform::rotate(1, 1, 1, 120).vector({1, 0, 0}), {0, 1, 0}), 1e-7);
}

TEST(Transform, RotateKeepsItsAxisAndLengths) {
    Random random(31);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 axis = random.direction(), v = random.direction();
        const Transform r = Transform::rotate(
            static_cast<double>(axis.x), static_cast<double>(axis.y), static_cast<double>(axis.z),
            static_cast<double>(random.uniform(-400, 400)));
        EXPECT_LT(distance(r.vector(axis), axis), 2e-7);
        EXPECT_NEAR(static_cast<double>(length(r.vector(v))), 1, 3e-7);
        EXPECT_NEAR(r.determinant(), 1, 1e-12);
    }
}

TEST(Transform, InverseUndoesThePoint) {
    Random random(32);
    for (int i = 0; i < 1000; ++i) {
        const Transform t = random_transform(random);
        const auto inverse = t.inverse();
        ASSERT_TRUE(inverse.has_value());
        const Transform identity = *inverse * t;
        for (std::size_t r = 0; r < 4; ++r)
            for (std::size_t c = 0; c < 4; ++c)
                EXPECT_NEAR(identity.m[r][c], r == c ? 1 : 0, 1e-12);
        const Vec3 p = random.point(-5, 5);
        EXPECT_LT(distance(inverse->point(t.point(p)), p), 2e-5);
    }
}

TEST(Transform, InverseIsRefusedWhereItDoesNotExist) {
    EXPECT_FALSE(Transform::scale(1, 0, 1).inverse().has_value());
    Transform flat; // third row = first + second
    flat.m[0] = {1, 2, 3, 0};
    flat.m[1] = {4, 5, 6, 0};
    flat.m[2] = {5, 7, 9, 0};
    EXPECT_FALSE(flat.inverse().has_value());
    Transform broken;
    broken.m[1][1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(broken.inverse().has_value());
    broken.m[1][1] = 1;
    broken.m[0][3] = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(broken.inverse().has_value());
    // Small is not singular: the measure is relative.
    EXPECT_TRUE(Transform::scale(1e-9, 1e-9, 1e-9).inverse().has_value());
}

TEST(Transform, NormalsStayPerpendicularUnderUnevenScalesAndMirrors) {
    Random random(33);
    for (int i = 0; i < 1000; ++i) {
        const double mirror = i % 2 == 0 ? 1 : -1;
        const Transform t = random_transform(random) * Transform::scale(mirror, 1, 1);
        const Vec3 a = random.direction(), b = random.direction();
        if (length(cross(a, b)) < 0.2f)
            continue;
        const Vec3 n = normalize(cross(a, b));
        const Vec3 moved = t.normal(n);
        EXPECT_NEAR(static_cast<double>(length(moved)), 1, 2e-7);
        EXPECT_NEAR(static_cast<double>(dot(moved, safe_normalize(t.vector(a)))), 0, 2e-6);
        EXPECT_NEAR(static_cast<double>(dot(moved, safe_normalize(t.vector(b)))), 0, 2e-6);
        // It points to the side that n pointed to, mirrored or not.
        EXPECT_GT(dot(moved, t.vector(n)), 0.0f);
    }
}

TEST(LookAt, BuildsTheCameraFrame) {
    const auto camera = Transform::look_at({1, 2, 3}, {1, 2, -7}, {0, 1, 0});
    ASSERT_TRUE(camera.has_value());
    EXPECT_EQ(camera->point({0, 0, 0}), (Vec3{1, 2, 3}));
    EXPECT_EQ(camera->vector({0, 0, 1}), (Vec3{0, 0, -1})); // looks at the target
    EXPECT_EQ(camera->vector({0, 1, 0}), (Vec3{0, 1, 0}));
    EXPECT_EQ(camera->vector({1, 0, 0}), (Vec3{-1, 0, 0})); // +x is the left of the image
    EXPECT_NEAR(camera->determinant(), 1, 1e-12);
}

TEST(LookAt, RefusesAViewAlongUp) {
    const Vec3 origin{0, 0, 0}, up{0, 1, 0};
    EXPECT_FALSE(Transform::look_at(origin, {0, 5, 0}, up).has_value());
    EXPECT_FALSE(Transform::look_at(origin, {0, -5, 0}, up).has_value());
    EXPECT_FALSE(Transform::look_at(origin, {0.99e-4f, 1, 0}, up).has_value());
    EXPECT_TRUE(Transform::look_at(origin, {1.01e-4f, 1, 0}, up).has_value());
    EXPECT_FALSE(Transform::look_at(origin, {0.99e-4f, 1, 0}, {0, 1e-3f, 0}).has_value());
    EXPECT_FALSE(Transform::look_at(origin, origin, up).has_value());
    EXPECT_FALSE(Transform::look_at(origin, {1, 0, 0}, {0, 0, 0}).has_value());
    EXPECT_FALSE(Transform::look_at(origin, {std::nanf(""), 0, 0}, up).has_value());
}

TEST(LookAt, HasTheRightRollCloseToTheLimit) {
    // View (1.5e-4 cos a, 1, 1.5e-4 sin a), up = +y: the left axis is up x view, so its angle in
    // the xz plane is known; a float construction is off by degrees here.
    for (int i = 0; i < 64; ++i) {
        const double angle = 6.283185307179586 * i / 64;
        const Vec3 target{static_cast<float>(1.5e-4 * std::cos(angle)), 1,
                          static_cast<float>(1.5e-4 * std::sin(angle))};
        const auto camera = Transform::look_at({0, 0, 0}, target, {0, 1, 0});
        ASSERT_TRUE(camera.has_value());
        const double dx = static_cast<double>(target.x), dz = static_cast<double>(target.z);
        const double norm = std::hypot(dx, dz);
        EXPECT_NEAR(camera->m[0][0], dz / norm, 1e-9);
        EXPECT_NEAR(camera->m[1][0], 0, 1e-9);
        EXPECT_NEAR(camera->m[2][0], -dx / norm, 1e-9);
    }
}

} // namespace
} // namespace plumb::test
