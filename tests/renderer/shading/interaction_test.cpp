/// \file  Hit points, their error bounds and normals.

#include "renderer/shading/interaction.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace plumb::test {
namespace {

/// One triangle and one sphere, the triangle with shading normals if any are given.
struct View {
    std::vector<Vec3> positions;
    std::vector<Triangle> triangles{{0, 1, 2}};
    std::vector<Vec3> vertex_normals;
    std::vector<Sphere> spheres{{}};
    std::vector<Surface> surfaces{2};
    std::vector<MeshView> meshes;
    std::vector<std::span<const Vec3>> normals;

    SceneView view() {
        meshes = {{positions, triangles}};
        normals = {vertex_normals};
        SceneView scene;
        scene.geometry = {meshes, spheres};
        scene.surfaces = surfaces;
        scene.normals = normals;
        return scene;
    }
};

const Ray down{{0.2f, 0.3f, 5}, 0, {0, 0, -1}, infinity};

Hit triangle_hit(float u, float v) { return {1, u, v, 0, 0, invalid_id}; }

TEST(Interaction, OfATriangleIsAtItsBarycentrics) {
    View data;
    data.positions = {{0, 0, 1}, {2, 0, 1}, {0, 4, 1}};
    const Interaction it = interact<false, false>(data.view(), triangle_hit(0.25f, 0.125f), down);
    EXPECT_NEAR(it.position.x, 0.5f, 2e-6f); // drawn inwards, see inward_share
    EXPECT_NEAR(it.position.y, 0.5f, 2e-6f);
    EXPECT_EQ(it.position.z, 1);
    EXPECT_EQ(it.geometric, (Vec3{0, 0, 1}));
    EXPECT_EQ(it.shading, it.geometric);
}

/// The exact point is inside the bound, on every axis, also where one vertex is far away from the
/// others and the weights sum to 1 with an error.
TEST(Interaction, BoundsTheErrorOfTrianglePoints) {
    Random random(1);
    for (int i = 0; i < 200000; ++i) {
        View data;
        for (int k = 0; k < 3; ++k) {
            const Vec3 p = random.direction() * std::exp(random.uniform(-4, 10));
            data.positions.push_back(p);
        }
        float u = random.uniform(), v = random.uniform() * (1 - u);
        if (i % 3 == 0) { // near the edge across from the first vertex
            v = 1 - u - 1e-6f * random.uniform();
            v = max(v, 0.0f);
        }
        const Interaction it = interact<false, false>(data.view(), triangle_hit(u, v), down);
        for (int axis = 0; axis < 3; ++axis) {
            const auto at = [&](std::size_t k) {
                return static_cast<long double>(data.positions[k][axis]);
            };
            const long double share = detail::inward_share;
            const long double lu = u * (1 - 3 * share) + share, lv = v * (1 - 3 * share) + share;
            const long double exact = (1 - lu - lv) * at(0) + lu * at(1) + lv * at(2);
            ASSERT_LE(std::fabs(static_cast<long double>(it.position[axis]) - exact),
                      static_cast<long double>(it.error[axis]))
                << i << ' ' << axis;
        }
    }
}

/// A point on an edge must not lie on the wall that meets the triangle there: rays from it would
/// leave a closed room. Expected: inside of the edge by more than a rounding, hardly moved.
TEST(Interaction, DrawsTrianglePointsOffTheEdges) {
    Random random(7);
    for (int i = 0; i < 100000; ++i) {
        const float wall = random.uniform(-1, 1), size = random.uniform(1, 2);
        View data; // on z = 0, its first edge along x = wall
        data.positions = {{wall, -size, 0}, {wall, size, 0}, {wall + size, 0.3f * size, 0}};
        const float u = random.uniform();
        const Interaction it = interact<false, false>(data.view(), triangle_hit(u, 0), down);
        ASSERT_GT(it.position.x, wall) << i;
        ASSERT_LT(it.position.x, wall + 1e-6f * (size + std::fabs(wall))) << i;
    }
}

/// Points of spheres are projected back: within the bound of the exact surface.
TEST(Interaction, PutsSpherePointsOntoTheSphere) {
    Random random(2);
    for (int i = 0; i < 100000; ++i) {
        View data;
        data.positions = {{}, {}, {}};
        const float offset = i % 2 == 0 ? 1.0f : 1000.0f;
        const Sphere sphere{random.point(-offset, offset), std::exp(random.uniform(-3, 3))};
        data.spheres = {sphere};
        const Vec3 out = random.direction();
        const Vec3 origin = sphere.center + out * (3 * sphere.radius);
        const Ray ray{origin, 0, -out, infinity};
        const Interaction it = interact<true, false>(
            data.view(), {2 * sphere.radius * 1.001f, 0, 0, 1, 0, invalid_id}, ray);
        double d2 = 0, bound = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double d =
                static_cast<double>(it.position[axis]) - static_cast<double>(sphere.center[axis]);
            d2 += d * d;
            bound += static_cast<double>(it.error[axis]);
        }
        ASSERT_LE(std::fabs(std::sqrt(d2) - static_cast<double>(sphere.radius)), bound);
        ASSERT_NEAR(dot(it.geometric, out), 1, 1e-5);
    }
}

TEST(Interaction, TurnsTheNormalOfAFlippedSphere) {
    View data;
    data.positions = {{}, {}, {}};
    const Ray ray{{0, 0, 3}, 0, {0, 0, -1}, infinity};
    const Hit hit{2, 0, 0, 1, 0, invalid_id};
    EXPECT_EQ((interact<true, false>(data.view(), hit, ray).geometric), (Vec3{0, 0, 1}));
    data.surfaces[1].flip_normal = true;
    const Interaction it = interact<true, false>(data.view(), hit, ray);
    EXPECT_EQ(it.geometric, (Vec3{0, 0, -1}));
    EXPECT_EQ(it.shading, it.geometric);
    EXPECT_EQ(it.position, (Vec3{0, 0, 1}));
}

TEST(Interaction, InterpolatesShadingNormals) {
    View data;
    data.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.vertex_normals = {{0, 0, 1}, {0.6f, 0, 0.8f}, {0, 0.6f, 0.8f}};
    const Hit hit = triangle_hit(0.5f, 0.25f);
    const Interaction smooth = interact<false, true>(data.view(), hit, down);
    const Vec3 wanted = normalize(Vec3{0.3f, 0.15f, 0.25f + 0.4f + 0.2f});
    EXPECT_NEAR(length(smooth.shading - wanted), 0, 1e-6);
    EXPECT_EQ(smooth.geometric, (Vec3{0, 0, 1}));
    EXPECT_EQ((interact<false, false>(data.view(), hit, down).shading), (Vec3{0, 0, 1}));
    // Opposite normals cancel: the geometric one stands in.
    data.vertex_normals = {{0, 0, 1}, {0, 1, 0}, {0, -1, 0}};
    EXPECT_EQ((interact<false, true>(data.view(), triangle_hit(0.5f, 0.5f), down).shading),
              (Vec3{0, 0, 1}));
}

/// Slivers, points and tiny or huge triangles: a finite unit normal and a finite point.
TEST(Interaction, IsFiniteForDegenerateTriangles) {
    const std::vector<std::vector<Vec3>> shapes{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}},
                                                {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}},
                                                {{0, 0, 0}, {1e-20f, 0, 0}, {0, 1e-20f, 0}},
                                                {{0, 0, 0}, {1e18f, 0, 0}, {0, 1e18f, 0}},
                                                {{0, 0, 0}, {1, 0, 0}, {0.5f, 1e-30f, 0}},
                                                {{1e6f, 0, 0}, {1e6f, 1, 0}, {1e6f, 0.5f, 1e-7f}}};
    for (const auto& shape : shapes) {
        View data;
        data.positions = shape;
        const Interaction it = interact<false, false>(data.view(), triangle_hit(0.3f, 0.3f), down);
        EXPECT_NEAR(length(it.geometric), 1, 1e-6) << &shape - shapes.data();
        EXPECT_TRUE(is_finite(it.position));
        const Vec3 origin = offset_origin(it.position, it.error, it.geometric, {0, 0, 1});
        EXPECT_FALSE(std::isnan(origin.x + origin.y + origin.z)) << &shape - shapes.data();
    }
}

TEST(OffsetOrigin, MovesToTheSideOfTheDirection) {
    const Vec3 position{1, 2, 3}, error{1e-6f, 1e-6f, 1e-6f}, normal{0, 0.6f, 0.8f};
    for (const Vec3 direction : {Vec3{0.1f, 0.5f, 0.9f}, Vec3{0.1f, -0.5f, -0.9f}}) {
        const Vec3 moved = offset_origin(position, error, normal, direction) - position;
        EXPECT_GT(dot(moved, normal) * dot(direction, normal), 0);
        EXPECT_GE(std::fabs(dot(moved, normal)), 1.4e-6f); // |n| . error
        EXPECT_LT(length(moved), 4e-6f);
    }
}

TEST(NextFloat, StepsOneUlpEitherWay) {
    for (const float x : {1.0f, -1.0f, 0.5f, 1e-30f, -3.25e7f, 1e-45f, -1e-45f}) {
        EXPECT_EQ(detail::next_float(x, true), std::nextafter(x, infinity));
        EXPECT_EQ(detail::next_float(x, false), std::nextafter(x, -infinity));
    }
    EXPECT_EQ(detail::next_float(0, true), std::numeric_limits<float>::denorm_min());
    for (const std::uint32_t nan : {0x7fffffffu, 0xffc00000u, 0x7f800001u, 0xffffffffu})
        for (const bool up : {true, false}) // a GPU's and a CPU's NaN
            EXPECT_TRUE(std::isnan(detail::next_float(std::bit_cast<float>(nan), up)));
    EXPECT_EQ(detail::next_float(-0.0f, false), -std::numeric_limits<float>::denorm_min());
}

} // namespace
} // namespace plumb::test
