/// \file  Areas, bounds, pdfs and surface points of single primitives.

#include "accel/geometry.h"
#include "tests/support/meshes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumb::test {
namespace {

TEST(Geometry, CountsTrianglesAndSpheres) {
    EXPECT_EQ(GeometryView{}.primitive_count(), 0u);
    TestGeometry scene;
    scene.add(box({0, 0, 0}, {1, 1, 1}));
    scene.add(repeated_triangle(3));
    scene.add(Sphere{});
    EXPECT_EQ(scene.view().primitive_count(), 16u);
    EXPECT_EQ(scene.view().sphere_geometry(), 2u);
    EXPECT_TRUE(scene.view().is_sphere(2));
    EXPECT_FALSE(scene.view().is_sphere(1));
}

TEST(Geometry, AreasAreThoseOfTheFormulas) {
    TestGeometry scene;
    Mesh mesh;
    mesh.add_triangle({0, 0, 0}, {3, 0, 0}, {0, 4, 0});           // 6
    mesh.add_triangle({1e4f, 0, 0}, {1e4f, 2, 0}, {1e4f, 0, 1});  // 1, far from the origin
    mesh.add_triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2});           // 0
    mesh.add_triangle({0, 0, 0}, {1e15f, 0, 0}, {0, 1e15f, 0});   // 5e29, beyond a float's square
    mesh.add_triangle({0, 0, 0}, {1e-25f, 0, 0}, {0, 1e-25f, 0}); // 5e-51
    scene.add(std::move(mesh));
    scene.add(Sphere{{1, 2, 3}, 2.5f});
    const GeometryView view = scene.view();
    EXPECT_DOUBLE_EQ(primitive_area(view, 0, 0), 6);
    EXPECT_DOUBLE_EQ(primitive_area(view, 0, 1), 1);
    EXPECT_DOUBLE_EQ(primitive_area(view, 0, 2), 0);
    EXPECT_NEAR(primitive_area(view, 0, 3) / 5e29, 1, 1e-6);
    EXPECT_NEAR(primitive_area(view, 0, 4) / 5e-51, 1, 1e-6);
    EXPECT_NEAR(primitive_area(view, 1, 0), 25 * 3.14159265358979323846, 1e-12);
    for (std::uint32_t i : {0u, 1u, 3u, 4u})
        EXPECT_DOUBLE_EQ(primitive_pdf_area(view, 0, i) * primitive_area(view, 0, i), 1);
    EXPECT_EQ(primitive_pdf_area(view, 0, 2), 0);
    EXPECT_DOUBLE_EQ(primitive_pdf_area(view, 1, 0) * primitive_area(view, 1, 0), 1);
}

TEST(Geometry, TheAreasOfAFineSphereAddUpToThatOfASphere) {
    // A mesh of rings r has the area of its sphere to O(1/r²): 200 rings, 1e-4.
    const TestGeometry scene(closed_sphere({1, 2, 3}, 2, 200));
    double area = 0;
    for (std::uint32_t i = 0; i < scene.meshes()[0].triangles.size(); ++i)
        area += primitive_area(scene.view(), 0, i);
    EXPECT_NEAR(area, 16 * 3.14159265358979323846, 2e-4 * 50);
}

TEST(Geometry, PrimitiveBoundsContainTheirSamples) {
    const TestGeometry scene = mixed_scene(131);
    const GeometryView view = scene.view();
    Random random(132);
    int outside = 0;
    const auto check = [&](std::uint32_t g, std::uint32_t p) {
        const Bounds bounds = primitive_bounds(view, g, p);
        EXPECT_FALSE(bounds.empty());
        for (int i = 0; i < 20; ++i) {
            const Vec3 x = sample_primitive(view, g, p, random.square()).position;
            outside += !bounds.contains(Bounds{x, x});
        }
    };
    for (std::uint32_t g = 0; g < view.meshes.size(); ++g)
        for (std::uint32_t p = 0; p < view.meshes[g].triangles.size(); ++p)
            check(g, p);
    for (std::uint32_t p = 0; p < view.spheres.size(); ++p)
        check(view.sphere_geometry(), p);
    EXPECT_EQ(outside, 0);
}

TEST(Geometry, NormalsFaceTheCounterClockwiseSideAndOutwards) {
    TestGeometry scene;
    scene.add(closed_sphere({5, 0, 0}, 2, 8));
    scene.add(Sphere{{-3, 1, 2}, 0.5f});
    Random random(133);
    for (std::uint32_t i = 0; i < scene.meshes()[0].triangles.size(); ++i) {
        const SurfacePoint s = sample_primitive(scene.view(), 0, i, random.square());
        EXPECT_NEAR(static_cast<double>(length(s.normal)), 1, 2e-7);
        EXPECT_GT(dot(s.normal, s.position - Vec3{5, 0, 0}), 0.0f);
    }
    for (int i = 0; i < 1000; ++i) {
        const SurfacePoint s = sample_primitive(scene.view(), 1, 0, random.square());
        EXPECT_NEAR(static_cast<double>(length(s.normal)), 1, 5e-7);
        EXPECT_LT(length(s.position - (Vec3{-3, 1, 2} + 0.5f * s.normal)), 1e-6f);
    }
}

TEST(Geometry, SamplesAtTheCornersOfTheUnitSquareAreFinite) {
    const TestGeometry scene = mixed_scene(134);
    const float last = 1 - 0x1p-24f;
    for (const float x : {0.0f, 0x1p-30f, 0.5f, last})
        for (const float y : {0.0f, 0x1p-30f, 0.5f, last}) {
            for (const std::uint32_t g : {0u, scene.view().sphere_geometry()}) {
                const SurfacePoint s = sample_primitive(scene.view(), g, 3, {x, y});
                EXPECT_TRUE(is_finite(s.position));
                EXPECT_NEAR(static_cast<double>(length(s.normal)), 1, 5e-7);
            }
        }
}

TEST(Geometry, TraceableMeansFiniteBelowTheLimitAndNoTwoVerticesEqual) {
    TestGeometry scene;
    Mesh mesh;
    mesh.add_triangle({0, 0, 0}, {max_coordinate, 0, 0}, {0, -max_coordinate, 0});
    mesh.add_triangle({0, 0, 0}, {std::nextafter(max_coordinate, infinity), 0, 0}, {0, 1, 0});
    mesh.add_triangle({0, 0, 0}, {0, std::nanf(""), 0}, {0, 1, 0});
    mesh.add_triangle({0, 0, -infinity}, {1, 0, 0}, {0, 1, 0});
    mesh.add_triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2});     // collinear is not untraceable
    mesh.add_triangle({0, 0, 0}, {1, 0, 0}, {0, -0.0f, 0}); // two equal vertices are
    mesh.add_triangle({0, 0, 0}, {0, 0, 0}, {0, 1, 0});
    mesh.add_triangle({0, 1, 0}, {1, 0, 0}, {1, 0, 0});
    scene.add(std::move(mesh));
    for (const float radius : {1.0f, 0.0f, -1.0f, std::nanf(""), infinity})
        scene.add(Sphere{{0, 0, 0}, radius});
    scene.add(Sphere{{infinity, 0, 0}, 1});
    const GeometryView view = scene.view();
    const bool triangles[]{true, false, false, false, true, false, false, false};
    const bool spheres[]{true, false, false, false, false, false};
    for (std::uint32_t i = 0; i < 8; ++i)
        EXPECT_EQ(is_traceable(view, 0, i), triangles[i]) << i;
    for (std::uint32_t i = 0; i < 6; ++i)
        EXPECT_EQ(is_traceable(view, 1, i), spheres[i]) << i;
}

} // namespace
} // namespace plumb::test
