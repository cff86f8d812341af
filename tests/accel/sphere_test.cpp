/// \file  The sphere test alone, against extended precision.

#include "accel/sphere.h"
#include "tests/support/brute_force.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace plumb::test {
namespace {

bool intersect(const Sphere& sphere, const Ray& ray, PrimitiveHit& hit) {
    return intersect_sphere(PreparedRay(ray), sphere, ray.tmax, hit);
}

std::optional<ExactHit> exact(const Sphere& sphere, const Ray& ray, double slack = 0) {
    return exact_hit(GeometryView{{}, {&sphere, 1}}, 0, 0, ray, slack);
}

/// Distance of the hit from the surface in radii, after the hit is moved onto the sphere along its
/// normal in float, which is how a renderer finds the point.
double off_surface(const Sphere& s, const Ray& ray, float t) {
    const Vec3 normal = normalize(ray.origin + t * ray.direction - s.center);
    const Vec3 p = s.center + s.radius * normal;
    const double r = static_cast<double>(s.radius);
    const double distance = std::hypot(static_cast<double>(p.x) - static_cast<double>(s.center.x),
                                       static_cast<double>(p.y) - static_cast<double>(s.center.y),
                                       static_cast<double>(p.z) - static_cast<double>(s.center.z));
    return std::fabs(distance - r) / r;
}

/// Ray from `distance` away that passes the centre of `s` at `miss` radii.
Ray ray_past(Random& random, const Sphere& s, float distance, double miss) {
    const Vec3 back = random.direction();
    Vec3 side = cross(back, random.direction());
    side = normalize(side);
    const Vec3 origin = s.center + distance * back;
    const double offset = miss * static_cast<double>(s.radius);
    const auto aim = [&](float c, float o, float k) {
        return static_cast<float>(static_cast<double>(c) - static_cast<double>(o) +
                                  offset * static_cast<double>(k));
    };
    const Vec3 d{aim(s.center.x, origin.x, side.x), aim(s.center.y, origin.y, side.y),
                 aim(s.center.z, origin.z, side.z)};
    return {origin, 0, random.bits() % 2 == 0 ? d : normalize(d), infinity};
}

/// For every ratio of distance to radius: decisions, t and the reprojected position.
TEST(SphereTest, IsExactFromOneToTenThousandRadiiAway) {
    Random random(51);
    for (const float ratio : {1.001f, 2.0f, 10.0f, 100.0f, 1e3f, 1e4f}) {
        const Sphere sphere{{0.3f, -0.2f, 0.7f}, 0.25f};
        int wrong = 0, hits = 0;
        double worst_t = 0, worst_position = 0;
        for (int i = 0; i < 40000; ++i) {
            // Half of them within 1e-7 .. 1e-2 of the silhouette.
            const double near_rim = std::exp(-16 + 11 * random.uniform_double());
            const double miss =
                i % 2 == 0 ? 2 * random.uniform_double() : 1 + (i % 4 == 1 ? near_rim : -near_rim);
            const Ray ray = ray_past(random, sphere, ratio * sphere.radius, miss);
            PrimitiveHit hit{};
            const bool found = intersect(sphere, ray, hit);
            // A band of 1e-11 radii around the silhouette is left to double's own rounding.
            const bool surely = exact(sphere, ray, -1e-11).has_value();
            const bool maybe = exact(sphere, ray, 1e-11).has_value();
            wrong += found ? !maybe : surely;
            const auto e = exact(sphere, ray);
            if (!found || !e)
                continue;
            ++hits;
            if (e->edge > 1e-6) // else the root itself is ill-conditioned
                worst_t = std::max(worst_t, std::fabs(static_cast<double>(hit.t) - e->t) / e->t);
            worst_position = std::max(worst_position, off_surface(sphere, ray, hit.t));
        }
        EXPECT_EQ(wrong, 0) << ratio;
        EXPECT_GT(hits, 5000) << ratio;
        EXPECT_LT(worst_t, 4 * 0x1p-23) << ratio;
        EXPECT_LT(worst_position, 3e-7) << ratio;
    }
}

TEST(SphereTest, AHugeSphereIsAGoodWall) {
    // Radius 1e5: a float quadratic is wrong by 0.08 in t.
    const Sphere wall{{0, 0, -1e5f}, 1e5f};
    Random random(52);
    for (int i = 0; i < 20000; ++i) {
        const Vec3 origin{random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(0.1f, 10)};
        const Ray ray{origin, 0, Vec3{random.uniform(-5, 5), random.uniform(-5, 5), 0} - origin,
                      infinity};
        PrimitiveHit hit{};
        ASSERT_TRUE(intersect(wall, ray, hit));
        const double t = exact(wall, ray).value().t;
        EXPECT_LT(std::fabs(static_cast<double>(hit.t) - t), 4 * 0x1p-23 * t);
    }
}

TEST(SphereTest, TakesTheNearerCrossingWithinTheLimits) {
    const Sphere s{{0, 0, 0}, 1};
    PrimitiveHit hit{};
    Ray ray{{0, 0, 3}, 0, {0, 0, -1}, infinity};
    ASSERT_TRUE(intersect(s, ray, hit));
    EXPECT_EQ(hit.t, 2.0f);
    EXPECT_EQ(hit.u, 0.0f);
    EXPECT_EQ(hit.v, 0.0f);
    ray.tmin = 2; // exclusive: the far side is next
    ASSERT_TRUE(intersect(s, ray, hit));
    EXPECT_EQ(hit.t, 4.0f);
    ray.tmax = 4;
    EXPECT_TRUE(intersect(s, ray, hit)) << "tmax is inclusive";
    ray.tmax = std::nextafter(4.0f, 0.0f);
    EXPECT_FALSE(intersect(s, ray, hit));
    ray = {{0, 0, 0}, 0, {0, 2, 0}, infinity}; // from inside, t in lengths of the direction
    ASSERT_TRUE(intersect(s, ray, hit));
    EXPECT_EQ(hit.t, 0.5f);
    ray = {{0, 0, 3}, 0, {0, 0, 1}, infinity};
    EXPECT_FALSE(intersect(s, ray, hit)) << "behind the origin";
    ray = {{0, 1, 0}, 0, {0, 1, 0}, infinity};
    EXPECT_FALSE(intersect(s, ray, hit)) << "leaves from the surface";
    ray = {{0, 1, 0}, 0, {0, -1, 0}, infinity};
    ASSERT_TRUE(intersect(s, ray, hit)) << "enters from the surface";
    EXPECT_EQ(hit.t, 2.0f);
}

TEST(SphereBounds, ContainTheSphere) {
    Random random(53);
    for (int i = 0; i < 10000; ++i) {
        const float scale = std::ldexp(1.0f, static_cast<int>(random.index(60)) - 30);
        const Sphere s{scale * random.point(-1, 1), random.uniform(1e-6f, 2)};
        const Bounds b = sphere_bounds(s);
        for (int axis = 0; axis < 3; ++axis) {
            const double c = static_cast<double>(s.center[axis]), r = static_cast<double>(s.radius);
            EXPECT_LE(static_cast<double>(b.lower[axis]), c - r);
            EXPECT_GE(static_cast<double>(b.upper[axis]), c + r);
        }
    }
}

} // namespace
} // namespace plumb::test
