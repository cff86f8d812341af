/// \file  Rays that leave a surface do not meet it again, and thin gaps are still seen.

#include "renderer/shading/interaction.h"
#include "tests/support/meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace plumb::test {
namespace {

/// One mesh of given triangles and spheres, as kernels see them.
struct View {
    Mesh mesh;
    std::vector<Sphere> spheres;
    std::vector<MeshView> meshes;
    std::vector<Surface> surfaces{1};
    std::vector<std::span<const Vec3>> normals{{}};

    [[nodiscard]] SceneView view() {
        meshes = {mesh.view()};
        surfaces.resize(1 + spheres.size());
        SceneView scene;
        scene.geometry = {meshes, spheres};
        scene.surfaces = surfaces;
        scene.normals = normals;
        return scene;
    }
};

Hit hit_of(std::uint32_t geometry, std::uint32_t primitive, const PrimitiveHit& p) {
    return {p.t, p.u, p.v, geometry, primitive, invalid_id};
}

/// A direction in the hemisphere of n; every other one within 1e-7 .. 1 of the surface.
Vec3 leaving(Random& random, Vec3 n, bool grazing) {
    Vec3 d = random.direction();
    if (dot(d, n) < 0)
        d = -d;
    if (!grazing)
        return d;
    const float height = std::exp(-16 * random.uniform());
    return normalize(d - n * (dot(d, n) - height));
}

/// Weights of the vertices: anywhere, on an edge or in a corner.
Vec3 weights(Random& random) {
    Vec3 w{random.uniform(), random.uniform(), random.uniform()};
    const std::uint32_t place = random.index(8);
    if (place == 0)
        w.x = 0;
    if (place == 1)
        w.x = w.y = 0;
    if (place == 2)
        w.y = 1e-4f * w.y;
    return w / max(1e-20f, w.x + w.y + w.z);
}

struct Counts {
    int rays = 0, self_hits = 0, misses = 0;
    int sliver_rays = 0, sliver_hits = 0; ///< of triangles beyond max_aspect
};

/// Up to this ratio of the longest edge to the height above it no ray meets its own triangle again.
/// The error of t in the watertight test grows with the ratio.
constexpr double max_aspect = 1e4;

double aspect(Vec3 a, Vec3 b, Vec3 c) {
    const auto exact = [](Vec3 p, Vec3 q, int k) {
        return static_cast<double>(p[k]) - static_cast<double>(q[k]);
    };
    double ab = 0, bc = 0, ca = 0, cross2 = 0;
    for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3;
        ab += exact(b, a, k) * exact(b, a, k);
        bc += exact(c, b, k) * exact(c, b, k);
        ca += exact(a, c, k) * exact(a, c, k);
        const double n = exact(b, a, k) * exact(c, a, l) - exact(b, a, l) * exact(c, a, k);
        cross2 += n * n;
    }
    return std::max({ab, bc, ca}) / std::sqrt(cross2);
}

/// Rays from outside onto random places of the triangle, then away from the hit point, to the front
/// and to the back.
void leave_triangle(Random& random, Vec3 a, Vec3 b, Vec3 c, Counts& counts) {
    View data;
    data.mesh.add_triangle(a, b, c);
    const SceneView scene = data.view();
    const Vec3 w = weights(random);
    const Vec3 at = w.x * a + w.y * b + w.z * c;
    const float size = length(b - a);
    const bool sliver = aspect(a, b, c) > max_aspect;
    for (int i = 0; i < 4; ++i) {
        const Vec3 origin = at + random.direction() * (size * random.uniform(0.01f, 3));
        const Ray in{origin, 0, at - origin, infinity};
        PrimitiveHit p{};
        if (!is_valid(in) || !intersect_triangle(PreparedRay(in), a, b, c, in.tmax, p)) {
            ++counts.misses;
            continue;
        }
        const Interaction it = interact<true, false>(scene, hit_of(0, 0, p), in);
        for (const Vec3 side : {it.geometric, -it.geometric}) {
            const Vec3 d = leaving(random, side, i % 2 == 0);
            const Ray out{offset_origin(it.position, it.error, it.geometric, d), 0, d, infinity};
            PrimitiveHit again{};
            const bool hit =
                dot(d, side) > 0 && intersect_triangle(PreparedRay(out), a, b, c, infinity, again);
            ++(sliver ? counts.sliver_rays : counts.rays);
            (sliver ? counts.sliver_hits : counts.self_hits) += hit;
        }
    }
}

class RayOffset : public ::testing::TestWithParam<float> {};

/// stability.md, ray offset: 0 self-hits. Triangles of size 1 at the offset.
TEST_P(RayOffset, LeavesTriangles) {
    Random random(1);
    const float offset = GetParam();
    Counts counts;
    for (int i = 0; i < 25000; ++i) {
        const Vec3 center = Vec3{offset, -offset, offset} + random.point(-1, 1);
        leave_triangle(random, center + random.point(-1, 1), center + random.point(-1, 1),
                       center + random.point(-1, 1), counts);
    }
    EXPECT_EQ(counts.self_hits, 0);
    EXPECT_GT(counts.rays, 100000);
}

/// Small, large and thin triangles.
TEST_P(RayOffset, LeavesTrianglesOfAllSizesAndShapes) {
    Random random(2);
    const float offset = GetParam();
    Counts counts;
    for (int i = 0; i < 25000; ++i) {
        const float size = std::exp(random.uniform(-7, 9)),
                    width = size * random.uniform() * random.uniform();
        const Vec3 a = Vec3{offset, offset, -offset} + random.point(-1, 1);
        const Vec3 along = size * random.direction();
        leave_triangle(random, a, a + along,
                       a + along * random.uniform() + width * random.direction(), counts);
    }
    EXPECT_EQ(counts.self_hits, 0);
    EXPECT_GT(counts.rays, 20000);
    EXPECT_LE(counts.sliver_hits, 3e-2 * counts.sliver_rays);
}

/// Slivers of size 1 with aspects of 16 to 1e4, as sides of a fine cylinder are: any orientation or
/// along an axis, the short edge at any corner or none.
TEST_P(RayOffset, LeavesSlivers) {
    Random random(8);
    const float offset = GetParam();
    Counts counts;
    for (int i = 0; i < 200000; ++i) {
        Vec3 along = random.direction(), across = random.direction();
        if (i % 3 == 0) { // in one plane with an axis, or along it
            const int axis = static_cast<int>(random.index(3));
            along = {};
            along[axis] = 1;
            across[axis] = random.index(2) == 0 ? 0.0f : across[axis];
        }
        const float height = std::exp(random.uniform(-9.2f, -2.8f));
        const float place = random.index(2) == 0 ? 0.0f : random.uniform();
        Vec3 v[3];
        const std::uint32_t first = random.index(3);
        v[first] = Vec3{offset, -offset, offset} + random.point(-1, 1);
        v[(first + 1) % 3] = v[first] + along;
        v[(first + 2) % 3] = v[first] + place * along + height * across;
        leave_triangle(random, v[0], v[1], v[2], counts);
    }
    EXPECT_EQ(counts.self_hits, 0);
    EXPECT_GT(counts.rays, offset > 1e5f ? 0 : 500000);
}

/// Axis-aligned walls: one coordinate the same at all vertices.
TEST_P(RayOffset, LeavesAxisAlignedWalls) {
    Random random(3);
    const float offset = GetParam();
    Counts counts;
    for (int i = 0; i < 20000; ++i) {
        Vec3 v[3];
        const int axis = static_cast<int>(random.index(3));
        const float level = offset + random.uniform(-3, 3);
        for (Vec3& p : v) {
            p = Vec3{offset, offset, offset} + random.point(-10, 10);
            p[axis] = level;
        }
        leave_triangle(random, v[0], v[1], v[2], counts);
    }
    EXPECT_EQ(counts.self_hits, 0);
    EXPECT_GT(counts.rays, 80000);
}

/// Vertices of one triangle at very different distances from the origin: most are slivers.
TEST(RayOffsetOf, TrianglesThatReachFarAwayMeetsThemSeldom) {
    Random random(4);
    Counts counts;
    for (int i = 0; i < 50000; ++i) {
        const auto anywhere = [&] { return random.direction() * std::exp(random.uniform(-6, 12)); };
        const Vec3 a = anywhere(), b = anywhere();
        leave_triangle(random, a, b, anywhere(), counts);
    }
    EXPECT_EQ(counts.self_hits, 0);
    EXPECT_GT(counts.rays, 20000);
    EXPECT_GT(counts.sliver_rays, 30000);
    EXPECT_LT(counts.sliver_hits, 5e-3 * counts.sliver_rays);
}

/// Spheres, outwards and inwards: an inward ray meets the far side, not the near one.
TEST_P(RayOffset, LeavesSpheres) {
    Random random(5);
    const float offset = GetParam();
    int outward = 0, inward = 0, rays = 0, missed = 0;
    for (int i = 0; i < 100000; ++i) {
        View data;
        const float smallest = 1e-3f + 1e-4f * offset; // or it has no shape left in float
        const Sphere sphere{Vec3{offset, -offset, offset} + random.point(-1, 1),
                            smallest * std::exp(random.uniform(0, 8))};
        data.spheres = {sphere};
        const SceneView scene = data.view();
        const Vec3 origin =
            sphere.center + random.direction() * (sphere.radius * random.uniform(0.0f, 4.0f));
        const Vec3 target = sphere.center + random.direction() * (sphere.radius * random.uniform());
        const Ray in{origin, 0, target - origin, infinity};
        PrimitiveHit p{};
        if (!intersect_sphere(PreparedRay(in), sphere, in.tmax, p)) {
            ++missed;
            continue;
        }
        const Interaction it = interact<true, false>(scene, hit_of(1, 0, p), in);
        for (const bool out : {true, false}) {
            const Vec3 side = out ? it.geometric : -it.geometric;
            const Vec3 d = leaving(random, side, i % 2 == 0);
            const Ray ray{offset_origin(it.position, it.error, it.geometric, d), 0, d, infinity};
            PrimitiveHit again{};
            ++rays;
            const bool hit = intersect_sphere(PreparedRay(ray), sphere, infinity, again);
            if (out)
                outward += hit && dot(d, side) > 0;
            else // the chord is 2 r cos: nothing much shorter
                inward +=
                    hit && again.t < 1.9f * sphere.radius * dot(d, side) && dot(d, side) > 0.05f;
        }
    }
    EXPECT_EQ(outward, 0);
    EXPECT_EQ(inward, 0);
    EXPECT_GT(rays, 100000);
}

/// A second wall behind a gap of 1e-4 of the scene is met by every ray that is sent through it.
TEST_P(RayOffset, StillSeesAThinGap) {
    Random random(6);
    const float offset = GetParam();
    const float scene_size = max(10.0f, 2 * offset), gap = 1e-4f * scene_size;
    int lost = 0, rays = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 o{offset, offset, offset};
        const float s = scene_size;
        const Vec3 a = o, b = o + Vec3{s, 0, 0}, c = o + Vec3{0, s, 0};
        const Vec3 up{0, 0, gap};
        const Vec3 from = o + Vec3{0.3f * s * random.uniform(), 0.3f * s * random.uniform(), -s};
        const Vec3 to = o + Vec3{0.05f * s + 0.3f * s * random.uniform(),
                                 0.05f * s + 0.3f * s * random.uniform(), 0};
        const Ray in{from, 0, to - from, infinity};
        View data;
        data.mesh.add_triangle(a, b, c);
        const SceneView scene = data.view();
        PrimitiveHit p{};
        ASSERT_TRUE(intersect_triangle(PreparedRay(in), a, b, c, in.tmax, p));
        const Interaction it = interact<false, false>(scene, hit_of(0, 0, p), in);
        const Vec3 d = normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), 1});
        const Ray out{offset_origin(it.position, it.error, it.geometric, d), 0, d, infinity};
        PrimitiveHit second{};
        ++rays;
        lost += !intersect_triangle(PreparedRay(out), a + up, b + up, c + up, infinity, second);
    }
    EXPECT_EQ(lost, 0) << rays;
}

/// The gap of 1e-4 of the scene, beside a sliver as long as the scene of aspect 400.
TEST(RayOffsetOf, SliversDoesNotReachOverAThinGap) {
    Random random(9);
    for (int i = 0; i < 20000; ++i) {
        const Vec3 along = random.direction(), across = cross(along, random.direction());
        View data;
        const Vec3 a = random.point(-0.1f, 0.1f);
        data.mesh.add_triangle(a, a + along, a + normalize(across) / 400);
        const Ray in{{}, 0, {1, 0, 0}, infinity};
        const Interaction it = interact<false, false>(data.view(), {1, 0.3f, 0.3f, 0, 0, 0}, in);
        const Vec3 origin = offset_origin(it.position, it.error, it.geometric, it.geometric);
        ASSERT_LT(dot(origin - it.position, it.geometric), 1e-4f);
    }
}

INSTANTIATE_TEST_SUITE_P(AtOffset, RayOffset, ::testing::Values(0.0f, 1e2f, 1e4f, 1e6f),
                         [](const auto& tested) {
                             return std::to_string(static_cast<int>(tested.param));
                         });

/// stability.md measures what no offset costs: the tests above can see it.
TEST(RayOffsetOf, NothingAtAllMeetsTheSurfaceAgain) {
    Random random(7);
    int self_hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 a = random.point(-1, 1), b = random.point(-1, 1), c = random.point(-1, 1);
        View data;
        data.mesh.add_triangle(a, b, c);
        const SceneView scene = data.view();
        const Vec3 origin = random.point(-3, 3);
        const Vec3 at = (a + b + c) / 3;
        const Ray in{origin, 0, at - origin, infinity};
        PrimitiveHit p{};
        if (!intersect_triangle(PreparedRay(in), a, b, c, in.tmax, p))
            continue;
        const Interaction it = interact<false, false>(scene, hit_of(0, 0, p), in);
        const Vec3 d = leaving(random, it.geometric, false);
        PrimitiveHit again{};
        self_hits += intersect_triangle(PreparedRay({it.position, 0, d, infinity}), a, b, c,
                                        infinity, again);
    }
    EXPECT_GT(self_hits, 2000);
}

} // namespace
} // namespace plumb::test
