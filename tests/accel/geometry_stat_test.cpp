/// \file  Uniform sampling of primitives by chi², and the law behind the surface area heuristic.

#include "accel/geometry.h"
#include "accel/math/frame.h"
#include "tests/support/meshes.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace plumb::test {
namespace {

constexpr int samples = 400000;

struct Double3 {
    double x, y, z;
};
Double3 minus(Vec3 a, Vec3 b) {
    return {static_cast<double>(a.x) - static_cast<double>(b.x),
            static_cast<double>(a.y) - static_cast<double>(b.y),
            static_cast<double>(a.z) - static_cast<double>(b.z)};
}
double dot(Double3 a, Double3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Barycentrics (of b, of c) of a point in the plane of a triangle, by the normal equations.
std::array<double, 2> barycentrics(const TriangleVertices& t, Vec3 p) {
    const Double3 e1 = minus(t.b, t.a), e2 = minus(t.c, t.a), d = minus(p, t.a);
    const double a = dot(e1, e1), b = dot(e1, e2), c = dot(e2, e2), det = a * c - b * b;
    return {(c * dot(e1, d) - b * dot(e2, d)) / det, (a * dot(e2, d) - b * dot(e1, d)) / det};
}

/// A triangle cut into n² congruent small ones: all of the same area, so of the same probability.
TEST(SamplePrimitive, FillsEveryPartOfATriangleEvenly) {
    constexpr int n = 12;
    TestGeometry scene;
    Mesh mesh;
    mesh.add_triangle({1, 2, 3}, {7, 2.5f, 1}, {2, 4, -1});
    scene.add(std::move(mesh));
    const TriangleVertices t = scene.view().vertices(0, 0);
    std::vector<double> counts(n * n, 0), expected(n * n, samples / static_cast<double>(n * n));
    Random random(141);
    for (int i = 0; i < samples; ++i) {
        const auto [u, v] =
            barycentrics(t, sample_primitive(scene.view(), 0, 0, random.square()).position);
        ASSERT_GE(std::min({u, v, 1 - u - v}), -1e-5);
        // Row by v, then within the row: upright and inverted small triangles in turn.
        const int row = std::clamp(static_cast<int>(v * n), 0, n - 1);
        const int column = std::clamp(static_cast<int>(u * n), 0, n - 1 - row);
        const bool inverted = u * n - column + v * n - row > 1 && column < n - 1 - row;
        // Rows of 2 (n - row) - 1 small triangles follow each other.
        const int start = row * (2 * n - row);
        counts[static_cast<std::size_t>(start + 2 * column + (inverted ? 1 : 0))] += 1;
    }
    EXPECT_GT(chi_square_p_value(counts, expected), p_limit);
}

TEST(SamplePrimitive, HasItsCentroidWhereATriangleHasIt) {
    // Without the square root the mean of a barycentric is off by 10.8 %.
    TestGeometry scene;
    Mesh mesh;
    mesh.add_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    scene.add(std::move(mesh));
    Random random(142);
    MeanTest u, v, uv;
    for (int i = 0; i < samples; ++i) {
        const Vec3 p = sample_primitive(scene.view(), 0, 0, random.square()).position;
        u.add(static_cast<double>(p.x));
        v.add(static_cast<double>(p.y));
        uv.add(static_cast<double>(p.x) * static_cast<double>(p.y));
    }
    EXPECT_LE(std::fabs(u.z(1.0 / 3)), z_limit);
    EXPECT_LE(std::fabs(v.z(1.0 / 3)), z_limit);
    EXPECT_LE(std::fabs(uv.z(1.0 / 12)), z_limit); // integral of uv over the triangle, times 2
    EXPECT_NEAR(u.variance(), 1.0 / 18, 0.01 / 18);
}

TEST(SamplePrimitive, CoversASphereEvenly) {
    // Archimedes: z and phi are uniform; 16 x 24 cells of equal area.
    TestGeometry scene;
    scene.add(Sphere{{3, -2, 1}, 2.5f});
    std::vector<double> counts(std::size_t{16} * 24, 0);
    const std::vector<double> expected(counts.size(), samples / static_cast<double>(counts.size()));
    Random random(143);
    for (int i = 0; i < samples; ++i) {
        const SurfacePoint s = sample_primitive(scene.view(), 0, 0, random.square());
        const Double3 d = minus(s.position, {3, -2, 1});
        const double z = d.z / 2.5, phi = std::atan2(d.y, d.x) / (2 * std::numbers::pi) + 0.5;
        const int row = std::clamp(static_cast<int>((z + 1) * 8), 0, 15);
        const int column = std::clamp(static_cast<int>(phi * 24), 0, 23);
        counts[static_cast<std::size_t>(row * 24 + column)] += 1;
    }
    EXPECT_GT(chi_square_p_value(counts, expected), p_limit);
}

TEST(SurfaceAreaHeuristic, LinesThroughABoxMeetABoxInsideByTheRatioOfTheirAreas) {
    // The law that the SAH rests on: of isotropic uniform lines that meet a convex body, the share
    // that meets a convex body inside it is the ratio of their areas.
    const Bounds parent{{-1, -2, -0.5f}, {1, 1, 1.5f}};
    const std::array children{Bounds{{-1, -2, -0.5f}, {0, 1, 1.5f}},           // a half
                              Bounds{{-0.2f, -0.4f, 0}, {0.7f, 0.1f, 1}},      // inside
                              Bounds{{0.5f, -2, -0.5f}, {0.5f, 1, 1.5f}},      // flat
                              Bounds{{-0.9f, -1.9f, 0}, {-0.8f, 0.9f, 0.1f}}}; // long
    const Vec3 center = parent.center();
    const float radius = 0.51f * length(parent.extent());
    Random random(144);
    double through_parent = 0;
    std::array<double, children.size()> through{};
    while (through_parent < 1e6) {
        const Vec3 d = random.direction();
        const Frame frame(d);
        const float r = radius * std::sqrt(random.uniform()), phi = 2 * pi * random.uniform();
        const Vec3 start =
            center + r * std::cos(phi) * frame.s + r * std::sin(phi) * frame.t - 2 * radius * d;
        const SlabRay line(Ray{start, 0, d, infinity});
        const auto meets = [&](const Bounds& box) {
            return overlaps(slab_interval(line, box), 0, infinity);
        };
        if (!meets(parent))
            continue;
        through_parent += 1;
        for (std::size_t i = 0; i < children.size(); ++i)
            through[i] += meets(children[i]) ? 1 : 0;
    }
    for (std::size_t i = 0; i < children.size(); ++i) {
        const double share = surface_area(children[i]) / surface_area(parent);
        EXPECT_LE(std::fabs(z_of_share(through[i], through_parent, share)), 5.0) << i;
    }
}

} // namespace
} // namespace plumb::test
