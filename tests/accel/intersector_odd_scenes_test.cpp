/// \file  Suite of every Intersector: empty, degenerate, repeated and garbage geometry.

#include "tests/accel/intersector_suite.h"

#include <algorithm>
#include <array>

namespace plumb::test {
namespace {

class IntersectorOddScenes : public IntersectorTest {};
INSTANTIATE_TEST_SUITE_P(Every, IntersectorOddScenes, every_config(), config_name);

/// A hit that a renderer can use: finite, within the ray's limits, of a primitive that exists.
testing::AssertionResult is_sane(const GeometryView& view, const Ray& ray, const Hit& hit) {
    if (is_miss(hit))
        return testing::AssertionSuccess();
    if (!std::isfinite(hit.t) || !std::isfinite(hit.u) || !std::isfinite(hit.v))
        return testing::AssertionFailure()
               << "not finite: " << hit.t << ' ' << hit.u << ' ' << hit.v;
    if (!(hit.t > ray.tmin && hit.t <= ray.tmax))
        return testing::AssertionFailure() << "outside the limits: " << hit.t;
    const bool exists = hit.geometry < view.meshes.size()
                            ? hit.primitive < view.meshes[hit.geometry].triangles.size()
                            : view.is_sphere(hit.geometry) && hit.primitive < view.spheres.size();
    if (!exists)
        return testing::AssertionFailure() << "no such primitive";
    return testing::AssertionSuccess();
}

void expect_only_misses(const Intersector& accel) {
    Random random(101);
    for (int i = 0; i < 1000; ++i) {
        const Ray ray = random_ray(random);
        EXPECT_TRUE(is_miss(accel.closest(ray)));
        EXPECT_FALSE(accel.occluded(ray));
    }
}

TEST_P(IntersectorOddScenes, AnEmptySceneIsAllMisses) {
    const auto nothing = build(GeometryView{});
    expect_only_misses(*nothing);
    EXPECT_EQ(nothing->stats().primitive_count, 0u);
    TestGeometry empty_meshes;
    empty_meshes.add(Mesh{});
    empty_meshes.add(Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}});
    expect_only_misses(*build(empty_meshes.view()));
}

TEST_P(IntersectorOddScenes, AMeshIdCountsEmptyMeshesToo) {
    TestGeometry scene;
    scene.add(Mesh{});
    scene.add(repeated_triangle(1));
    scene.add(Mesh{});
    scene.add(Sphere{{0, 0, -5}, 1});
    const auto accel = build(scene.view());
    const Hit triangle = accel->closest(Ray{{0, 0, 4}, 0, {0, 0, -1}, infinity});
    EXPECT_EQ(triangle.geometry, 1u);
    EXPECT_EQ(triangle.primitive, 0u);
    const Hit sphere = accel->closest(Ray{{0, 0, -9}, 0, {0, 0, 1}, infinity});
    EXPECT_EQ(sphere.geometry, 3u);
    EXPECT_EQ(sphere.primitive, 0u);
    EXPECT_EQ(sphere.t, 3.0f);
}

TEST_P(IntersectorOddScenes, OnlyDegenerateTrianglesGiveNoBadHit) {
    Random random(102);
    Mesh mesh;
    for (int i = 0; i < 300; ++i) {
        const Vec3 a = random.point(-1, 1), d = random.direction();
        mesh.add_triangle(a, a, a);
        mesh.add_triangle(a, a, a + d);
        mesh.add_triangle(a, a + d, a + 0.5f * d);
    }
    for (int i = 0; i < 100; ++i)
        mesh.add_triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0});
    const TestGeometry scene(std::move(mesh));
    const auto accel = build(scene.view());
    for (int i = 0; i < 5000; ++i) {
        Ray ray = random_ray(random);
        if (i % 2 == 0) {
            const auto& p = scene.meshes()[0].positions;
            ray.direction = p[random.index(static_cast<std::uint32_t>(p.size()))] - ray.origin;
        }
        const Hit hit = accel->closest(ray);
        ASSERT_TRUE(is_sane(scene.view(), ray, hit));
        ASSERT_EQ(accel->occluded(ray), hit.valid());
    }
}

TEST_P(IntersectorOddScenes, CopiesOfOnePrimitiveAreOneHit) {
    const Ray through{{0.1f, -0.2f, 4}, 0, {0, 0, -1}, infinity};
    for (const std::size_t copies : {1000u, 10000u, 100000u}) {
        TestGeometry scene(repeated_triangle(copies));
        for (std::size_t i = 0; i < copies; ++i)
            scene.add(Sphere{{0, 0, -4}, 1});
        const auto accel = build(scene.view());
        const auto single = TestGeometry(repeated_triangle(1));
        const Hit expected = build(single.view())->closest(through), hit = accel->closest(through);
        ASSERT_TRUE(hit.valid());
        EXPECT_EQ(hit.t, expected.t);
        EXPECT_EQ(hit.u, expected.u);
        EXPECT_EQ(hit.v, expected.v);
        EXPECT_EQ(hit.geometry, 0u);
        const Hit sphere = accel->closest(Ray{{0, 0, -9}, 0, {0, 0, 1}, infinity});
        EXPECT_EQ(sphere.geometry, 1u);
        EXPECT_EQ(sphere.t, 4.0f);
        if (GetParam().kind != AccelKind::embree) {
            EXPECT_EQ(hit.primitive, 0u);
            EXPECT_EQ(sphere.primitive, 0u);
            EXPECT_LE(accel->stats().depth, 64);
        }
        EXPECT_FALSE(accel->closest(Ray{{0.1f, -0.2f, 4}, 0, {0, 0, 1}, infinity}).valid());
        EXPECT_EQ(accel->stats().primitive_count, 2 * copies);
    }
}

float any_bits(Random& random) { return std::bit_cast<float>(random.bits()); }
Vec3 any_point(Random& random) { return {any_bits(random), any_bits(random), any_bits(random)}; }

/// Vertices of any bit pattern, huge, tiny, NaN and infinite, and some that are sensible.
TestGeometry garbage_scene(Random& random) {
    TestGeometry scene;
    Mesh mesh;
    for (int i = 0; i < 30; ++i)
        mesh.add_triangle(any_point(random), any_point(random), any_point(random));
    for (int i = 0; i < 10; ++i)
        mesh.add_triangle(random.point(-1, 1), random.point(-1, 1),
                          i % 2 == 0 ? any_point(random) : random.point(-1, 1));
    scene.add(std::move(mesh));
    for (int i = 0; i < 10; ++i)
        scene.add(Sphere{i % 2 == 0 ? any_point(random) : random.point(-1, 1),
                         i % 3 == 0 ? 0.3f : any_bits(random)});
    return scene;
}

TEST_P(IntersectorOddScenes, GarbageVerticesGiveNoCrashAndNoNonFiniteHit) {
    Random random(103);
    int hits = 0;
    for (int s = 0; s < 1000; ++s) {
        const TestGeometry scene = garbage_scene(random);
        const auto accel = build(scene.view());
        for (int i = 0; i < 20; ++i) {
            Ray ray = random_ray(random);
            if (i % 4 == 0) {
                ray.origin = any_point(random);
                ray.direction = any_point(random);
            }
            const Hit hit = accel->closest(ray);
            ASSERT_TRUE(is_sane(scene.view(), ray, hit)) << "scene " << s;
            ASSERT_EQ(accel->occluded(ray), hit.valid()) << "scene " << s;
            hits += hit.valid();
        }
    }
    EXPECT_GT(hits, 2000);
}

TEST_P(IntersectorOddScenes, PrimitivesThatAreNotTraceableAreSkippedAndCounted) {
    const float nan = std::nanf("");
    TestGeometry scene;
    Mesh mesh = repeated_triangle(1);
    mesh.add_triangle({0, 0, nan}, {1, 0, 0}, {0, 1, 0});
    mesh.add_triangle({0, 0, 0}, {infinity, 0, 0}, {0, 1, 0});
    mesh.add_triangle({0, 0, 0}, {1, 0, 0}, {0, 2e18f, 0});
    scene.add(std::move(mesh));
    for (const float radius : {0.0f, -1.0f, nan, infinity})
        scene.add(Sphere{{0, 0, 0}, radius});
    scene.add(Sphere{{nan, 0, 0}, 1});
    scene.add(Sphere{{0, 0, -4}, 1});
    const auto accel = build(scene.view());
    EXPECT_EQ(accel->stats().skipped_count, 8u);
    const Hit hit = accel->closest(Ray{{0, 0, 4}, 0, {0, 0, -1}, infinity});
    EXPECT_EQ(hit.geometry, 0u);
    EXPECT_EQ(hit.primitive, 0u);
    const Hit sphere = accel->closest(Ray{{0, 0, -9}, 0, {0, 0, 1}, infinity});
    EXPECT_EQ(sphere.geometry, 1u);
    EXPECT_EQ(sphere.primitive, 5u);
}

TEST_P(IntersectorOddScenes, TheTrianglesOfEmbreesPullRequest489AreHit) {
    // Coordinates on which Embree's spatial split and its binning once disagreed (PR #489).
    constexpr std::array c{-6.4000024f, 25.6f, 34.0f, 57.6000022f};
    Mesh mesh;
    for (const float x : c)
        for (const float y : c) {
            mesh.add_triangle({x, y, c[0]}, {x, y, c[3]}, {y, x, c[1]});
            mesh.add_triangle({c[0], x, y}, {c[3], y, x}, {c[2], x, x});
        }
    const TestGeometry scene(std::move(mesh));
    const auto accel = build(scene.view());
    Random random(104);
    int hits = 0;
    for (int i = 0; i < 5000; ++i) {
        const Vec3 origin = random.point(-50, 100);
        const Ray ray{origin, 0, random.point(-6.4f, 57.6f) - origin, infinity};
        const auto exact = brute_force_closest(scene.view(), ray);
        const Hit hit = accel->closest(ray);
        hits += hit.valid();
        if (hit.valid() != exact.has_value()) {
            EXPECT_LT(exact ? exact->edge : 0, 1e-4) << i;
        } else if (exact && exact->edge > 1e-4) {
            EXPECT_NEAR(static_cast<double>(hit.t), exact->t, 1e-3) << i;
        }
    }
    EXPECT_GT(hits, 500);
}

} // namespace
} // namespace plumb::test
