/// \file  The two triangle tests alone, against extended precision.

#include "accel/math/frame.h"
#include "accel/triangle.h"
#include "accel/validate/referee.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace plumb::test {
namespace {

/// 16 ulp of 1: barycentrics and t are of that size in the scenes where this limit is used.
constexpr double limit = 16 * 0x1p-23;

struct Case {
    TriangleVertices triangle;
    Ray ray;
};

/// A triangle of edges about 1 and a ray towards its inside that is not grazing.
Case random_case(Random& random) {
    for (;;) {
        Case c;
        c.triangle = {random.point(-1, 1), random.point(-1, 1), random.point(-1, 1)};
        const Vec3 normal = cross(c.triangle.b - c.triangle.a, c.triangle.c - c.triangle.a);
        float u = random.uniform(), v = random.uniform();
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const Vec3 target = (1 - u - v) * c.triangle.a + u * c.triangle.b + v * c.triangle.c;
        c.ray.origin = target + random.uniform(0.5f, 2) * random.direction();
        c.ray.direction = normalize(target - c.ray.origin);
        const float cosine = std::fabs(dot(normal, c.ray.direction)) / length(normal);
        if (length(normal) > 0.3f && cosine > 0.3f && std::min({u, v, 1 - u - v}) > 0.01f)
            return c;
    }
}

template <TriangleTest Test>
bool intersect(const TriangleVertices& t, const Ray& ray, PrimitiveHit& hit) {
    return intersect_triangle<Test>(PreparedRay(ray), t.a, t.b, t.c, ray.tmax, hit);
}

ExactHit exact(const Case& c) {
    const std::array positions{c.triangle.a, c.triangle.b, c.triangle.c};
    const std::array<Triangle, 1> triangles{{{0, 1, 2}}};
    const std::array<MeshView, 1> meshes{{{positions, triangles}}};
    return exact_hit(GeometryView{meshes, {}}, 0, 0, c.ray).value();
}

template <TriangleTest Test> void expect_within_16_ulp() {
    Random random(41);
    for (int i = 0; i < 256; ++i) {
        const Case c = random_case(random);
        PrimitiveHit hit{};
        ASSERT_TRUE(intersect<Test>(c.triangle, c.ray, hit));
        const ExactHit e = exact(c);
        EXPECT_NEAR(static_cast<double>(hit.t), e.t, limit);
        EXPECT_NEAR(static_cast<double>(hit.u), e.u, limit);
        EXPECT_NEAR(static_cast<double>(hit.v), e.v, limit);
    }
}

TEST(TriangleTest, WatertightMatchesExtendedPrecision) {
    expect_within_16_ulp<TriangleTest::watertight>();
}

TEST(TriangleTest, MoellerTrumboreMatchesExtendedPrecision) {
    expect_within_16_ulp<TriangleTest::moeller_trumbore>();
}

template <TriangleTest Test> void expect_scaling_keeps_barycentrics() {
    Random random(42);
    for (int i = 0; i < 256; ++i) {
        Case c = random_case(random);
        PrimitiveHit unit{}, scaled{};
        ASSERT_TRUE(intersect<Test>(c.triangle, c.ray, unit));
        // A power of two scales every rounding with it: the same bits.
        const Vec3 direction = c.ray.direction;
        for (const float power : {0x1p-20f, 0.5f, 0x1p30f}) {
            c.ray.direction = power * direction;
            ASSERT_TRUE(intersect<Test>(c.triangle, c.ray, scaled));
            EXPECT_EQ(std::bit_cast<std::uint32_t>(scaled.u), std::bit_cast<std::uint32_t>(unit.u));
            EXPECT_EQ(std::bit_cast<std::uint32_t>(scaled.v), std::bit_cast<std::uint32_t>(unit.v));
            EXPECT_EQ(scaled.t * power, unit.t);
        }
        c.ray.direction = 0.3f * direction;
        ASSERT_TRUE(intersect<Test>(c.triangle, c.ray, scaled));
        EXPECT_NEAR(static_cast<double>(scaled.u), static_cast<double>(unit.u), limit);
        EXPECT_NEAR(static_cast<double>(scaled.v), static_cast<double>(unit.v), limit);
        EXPECT_NEAR(static_cast<double>(scaled.t * 0.3f), static_cast<double>(unit.t), limit);
    }
}

TEST(TriangleTest, ScalingTheDirectionKeepsBarycentrics) {
    expect_scaling_keeps_barycentrics<TriangleTest::watertight>();
    expect_scaling_keeps_barycentrics<TriangleTest::moeller_trumbore>();
}

template <TriangleTest Test> void expect_both_sides_and_limits() {
    const TriangleVertices t{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const TriangleVertices back{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}};
    PrimitiveHit hit{};
    Ray ray{{0.25f, 0.5f, 2}, 0, {0, 0, -1}, infinity};
    ASSERT_TRUE(intersect<Test>(t, ray, hit));
    EXPECT_EQ(hit.t, 2.0f);
    EXPECT_EQ(hit.u, 0.25f); // the weight of the second vertex
    EXPECT_EQ(hit.v, 0.5f);
    ASSERT_TRUE(intersect<Test>(back, ray, hit));
    EXPECT_EQ(hit.u, 0.5f);
    EXPECT_EQ(hit.v, 0.25f);
    ray.tmax = 2;
    EXPECT_TRUE(intersect<Test>(t, ray, hit)) << "tmax is inclusive";
    ray.tmax = std::nextafter(2.0f, 0.0f);
    EXPECT_FALSE(intersect<Test>(t, ray, hit));
    ray = {{0.25f, 0.5f, 2}, 2, {0, 0, -1}, infinity};
    EXPECT_FALSE(intersect<Test>(t, ray, hit)) << "tmin is exclusive";
    ray.tmin = std::nextafter(2.0f, 0.0f);
    EXPECT_TRUE(intersect<Test>(t, ray, hit));
    ray = {{0.25f, 0.5f, 2}, 0, {0, 0, 1}, infinity};
    EXPECT_FALSE(intersect<Test>(t, ray, hit)) << "behind the origin";
    ray = {{0.7f, 0.7f, 2}, 0, {0, 0, -1}, infinity};
    EXPECT_FALSE(intersect<Test>(t, ray, hit)) << "beyond the hypotenuse";
    ray = {{0.25f, 0.5f, 0}, 0, {0, 0, -1}, infinity};
    EXPECT_FALSE(intersect<Test>(t, ray, hit)) << "starts on the triangle";
}

TEST(TriangleTest, HitsBothSidesWithinHalfOpenLimits) {
    expect_both_sides_and_limits<TriangleTest::watertight>();
    expect_both_sides_and_limits<TriangleTest::moeller_trumbore>();
}

TEST(TriangleTest, WatertightNeverHitsATriangleWithTwoEqualVertices) {
    Random random(43);
    int hits = 0;
    for (int i = 0; i < 100000; ++i) {
        const Vec3 a = random.point(-5, 5), b = random.point(-5, 5);
        const Vec3 origin = random.point(-20, 20);
        const Ray ray{origin, 0, (i % 3 == 0 ? a : a + random.uniform() * (b - a)) - origin,
                      infinity};
        for (const TriangleVertices& t : {TriangleVertices{a, a, b}, TriangleVertices{a, b, a},
                                          TriangleVertices{b, a, a}, TriangleVertices{a, a, a}}) {
            PrimitiveHit hit{};
            hits += intersect<TriangleTest::watertight>(t, ray, hit);
        }
    }
    EXPECT_EQ(hits, 0);
}

TEST(TriangleTest, HitsOnDegenerateTrianglesAreFiniteAndInTheirBox) {
    // The shear rounds, so collinear vertices can be a sliver to the watertight test; to
    // Möller–Trumbore also two equal ones. What they must not do is hit outside their box.
    Random random(48);
    int wrong = 0;
    const auto check = [&](const TriangleVertices& t, const Ray& ray, const PrimitiveHit& hit) {
        const Interval box = slab_interval(SlabRay(ray), triangle_bounds(t.a, t.b, t.c));
        wrong += !(hit.t >= box.near && hit.t <= box.far && std::isfinite(hit.t) && hit.u >= 0 &&
                   hit.v >= 0 && hit.u + hit.v <= 1.0001f);
    };
    for (int i = 0; i < 100000; ++i) {
        const Vec3 a{static_cast<float>(random.index(9)), static_cast<float>(random.index(9)),
                     static_cast<float>(random.index(9))};
        const Vec3 step{1, 2, static_cast<float>(random.index(3))}; // small integers: exact
        const Vec3 target = a + 2 * random.uniform() * step, origin = random.point(-20, 20);
        const Ray ray{origin, 0, target - origin, infinity};
        for (const TriangleVertices& t :
             {TriangleVertices{a, a + step, a + 2 * step}, TriangleVertices{a + step, a, a}}) {
            PrimitiveHit hit{};
            if (intersect<TriangleTest::watertight>(t, ray, hit))
                check(t, ray, hit);
            if (intersect<TriangleTest::moeller_trumbore>(t, ray, hit))
                check(t, ray, hit);
        }
    }
    EXPECT_EQ(wrong, 0);
}

TEST(TriangleTest, HasNoAbsoluteEpsilon) {
    // Scaling the scene by a power of two changes no decision: an epsilon of 1e-8 on det would
    // miss all of a mesh of size 0.01.
    Random random(44);
    for (int i = 0; i < 256; ++i) {
        const Case c = random_case(random);
        for (const float scale : {0x1p-24f, 0x1p-10f, 0x1p24f}) {
            const TriangleVertices t{scale * c.triangle.a, scale * c.triangle.b,
                                     scale * c.triangle.c};
            const Ray ray{scale * c.ray.origin, 0, c.ray.direction, infinity};
            PrimitiveHit hit{}, unit{};
            ASSERT_TRUE(intersect<TriangleTest::watertight>(t, ray, hit)) << scale;
            ASSERT_TRUE(intersect<TriangleTest::watertight>(c.triangle, c.ray, unit));
            EXPECT_EQ(hit.t, scale * unit.t);
            ASSERT_TRUE(intersect<TriangleTest::moeller_trumbore>(t, ray, hit)) << scale;
        }
    }
}

TEST(TriangleTest, WatertightHitsTrianglesWhoseCubesOverflow) {
    Random random(45);
    for (int i = 0; i < 256; ++i) {
        const Case c = random_case(random);
        constexpr float scale = 0x1p48f;
        const TriangleVertices t{scale * c.triangle.a, scale * c.triangle.b, scale * c.triangle.c};
        const Ray ray{scale * c.ray.origin, 0, c.ray.direction, infinity};
        PrimitiveHit hit{}, unit{};
        ASSERT_TRUE(intersect<TriangleTest::watertight>(t, ray, hit));
        ASSERT_TRUE(intersect<TriangleTest::watertight>(c.triangle, c.ray, unit));
        EXPECT_NEAR(static_cast<double>(hit.t / scale), static_cast<double>(unit.t), 2 * limit);
    }
}

/// Rays from inside a closed mesh that hit none of its triangles.
template <class MakeRay> int escapes(const Mesh& mesh, int rays, MakeRay&& make_ray) {
    int lost = 0;
    for (int i = 0; i < rays; ++i) {
        const Ray ray = make_ray(i);
        const PreparedRay prepared(ray);
        PrimitiveHit hit{};
        lost += std::none_of(mesh.triangles.begin(), mesh.triangles.end(), [&](Triangle t) {
            return intersect_triangle(prepared, mesh.positions[t.a], mesh.positions[t.b],
                                      mesh.positions[t.c], ray.tmax, hit);
        });
    }
    return lost;
}

TEST(TriangleTest, WatertightLosesNothingAroundAFanOfNeedles) {
    // A double cone of 4000 needles around the z axis: every ray from inside hits it.
    Mesh cone;
    constexpr std::uint32_t sides = 500;
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double phi = 6.283185307179586 * i / sides;
        cone.positions.push_back(
            {static_cast<float>(std::cos(phi)), static_cast<float>(std::sin(phi)), 0.001f});
    }
    cone.positions.push_back({0, 0, 1});
    cone.positions.push_back({0, 0, -1});
    for (std::uint32_t i = 0; i < sides; ++i)
        for (const std::uint32_t apex : {sides, sides + 1})
            cone.triangles.push_back({i, (i + 1) % sides, apex});
    Random random(45);
    EXPECT_EQ(escapes(cone, 20000,
                      [&](int i) {
                          const Vec3 origin = random.point(-0.2f, 0.2f);
                          const Vec3 apex{0, 0, i % 2 == 0 ? 1.0f : -1.0f};
                          const Vec3 rim = cone.positions[random.index(sides)];
                          const float s = i % 3 == 0 ? 0.0f : random.uniform();
                          return Ray{origin, 0, apex + s * (rim - apex) - origin, infinity};
                      }),
              0);
}

/// A needle may be hit anywhere along it within rounding, but a ray across it has one distance.
TEST(TriangleTest, WatertightDistanceToANeedleAcrossTheRayIsExact) {
    Random random(53);
    for (int i = 0; i < 20000; ++i) {
        const Vec3 tail = random.point(-1, 1), along = random.direction();
        const Vec3 across = Frame(along).to_world({0.004f, 0, 0});
        const std::array positions{tail, tail + across, tail + 1.5f * along};
        const std::array<Triangle, 1> triangles{{{0, 1, 2}}};
        const std::array<MeshView, 1> meshes{{{positions, triangles}}};
        const Vec3 target = tail + 0.3f * across + random.uniform(0.1f, 1) * along;
        const Vec3 aside = Frame(along).to_world(
            {std::cos(6.28f * random.uniform()), std::sin(6.28f * random.uniform()), 0});
        const Vec3 origin = target + random.uniform(0.1f, 2) * aside;
        const Ray ray{origin, 0, target - origin, infinity};
        PrimitiveHit hit;
        if (!intersect<TriangleTest::watertight>({positions[0], positions[1], positions[2]}, ray,
                                                 hit))
            continue;
        const Judgement truth = judge(GeometryView{meshes, {}}, 0, 0, ray);
        ASSERT_TRUE(is_right_t(truth, hit.t)) << i << ": " << hit.t << ", not " << truth.near.t;
    }
}

TEST(TriangleTest, WatertightLosesNothingBesideTheEdgesOfLargeWalls) {
    // Origins at 1e-6 .. 1 of walls of 1900, aimed close to the edge between two of them: the
    // sheared vertices are wrong by more than the ray's distance from the edge. Without the margin
    // in triangle_bounds 27 % of these rays escape.
    Random random(46);
    const Mesh room = box({-1000.3f, -900.7f, -1000.1f}, {1.1f, 1.3f, 899.9f});
    EXPECT_EQ(escapes(room, 1000000,
                      [&](int) {
                          const float s = std::exp(random.uniform(-14, 0));
                          const Vec3 origin{1.1f - s * random.uniform(0.01f, 1),
                                            1.3f - s * random.uniform(0.01f, 1),
                                            random.uniform(-100, 100)};
                          Vec3 d{1.1f - origin.x, 1.3f - origin.y, s * random.uniform(-5, 5)};
                          d.x *= 1 + random.uniform(-1, 1) * std::exp(random.uniform(-14, -2));
                          return Ray{origin, 0, normalize(d), infinity};
                      }),
              0);
}

/// Found by fuzzing. A ray along an axis starts in a corner of a triangle's box, 2^-148 outside of
/// it across the ray: a plane that it never reaches must not push the hit to the far end.
TEST(TriangleTest, ARayBesideTheBoxOfItsTriangleIsHitWhereTheOtherAxesSay) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto turned = [axis](float along, float y, float z) {
            Vec3 v;
            v[axis] = along;
            v[(axis + 1) % 3] = y;
            v[(axis + 2) % 3] = z;
            return v;
        };
        const PreparedRay ray(Ray{{}, 0, turned(11.84f, 0, 0), infinity});
        PrimitiveHit hit;
        EXPECT_FALSE(intersect_triangle(ray, turned(0x1.48p-142f, 0x1.0ap-117f, 0x1p-148f),
                                        turned(0, 0, 0x1.060cp-123f), turned(11.84f, 35.2f, 9.6e6f),
                                        infinity, hit))
            << axis << ": at " << hit.t << ", not 0";
    }
}

TEST(TriangleBounds, ContainTheVerticesAndGrowByRoundingOnly) {
    Random random(47);
    for (int i = 0; i < 10000; ++i) {
        const float scale = std::ldexp(1.0f, static_cast<int>(random.index(100)) - 50);
        const Vec3 a = scale * random.point(-1, 1), b = scale * random.point(-1, 1),
                   c = scale * random.point(-1, 1);
        const Bounds tight = vertex_bounds(a, b, c), bounds = triangle_bounds(a, b, c);
        EXPECT_TRUE(bounds.contains(tight));
        for (const Vec3& p : {a, b, c})
            EXPECT_TRUE(tight.contains(Bounds{p, p}));
        EXPECT_LT(max_component(bounds.extent() - tight.extent()), 4e-6f * scale);
    }
}

} // namespace
} // namespace plumb::test
