/// \file  Suite of every Intersector: no ray leaves a closed mesh through an edge or a vertex.
///
/// The sizes, offsets and limits are those of the stability table. sah as it is by default has the
/// full 1e6 edge and 1e5 vertex rays of each mesh; the others a tenth, and all edge rays in the
/// worst case of the table, offset 1e6.

#include "tests/accel/intersector_suite.h"

#include <algorithm>
#include <array>

namespace plumb::test {
namespace {

class IntersectorWatertight : public IntersectorTest {};
INSTANTIATE_TEST_SUITE_P(Every, IntersectorWatertight, watertight_configs(), config_name);

constexpr std::array offsets{Vec3{0, 0, 0}, Vec3{1e2f, 1e2f, 1e2f}, Vec3{1e4f, 1e4f, 1e4f},
                             Vec3{1e6f, 1e6f, 1e6f}, Vec3{148376, 1234, -223423}};
constexpr std::array sizes{50.0f, 200.0f};

bool has_full_numbers(const Config& c) {
    return c.kind == AccelKind::sah && c.isa == Isa::automatic && c.quality == BuildQuality::medium;
}

/// What a share of the vertex rays may miss: Embree's robust mode loses 374 of 1e5.
double vertex_limit(AccelKind kind) { return kind == AccelKind::embree ? 0.005 : 0; }

/// Ray to a point given in double; the direction is rounded, every other one is normalised.
Ray ray_to(Random& random, Vec3 origin, double x, double y, double z) {
    const Vec3 d{static_cast<float>(x - static_cast<double>(origin.x)),
                 static_cast<float>(y - static_cast<double>(origin.y)),
                 static_cast<float>(z - static_cast<double>(origin.z))};
    return {origin, 0, random.index(2) == 0 ? d : normalize(d), infinity};
}

Ray ray_to_edge(Random& random, const Mesh& mesh, const std::vector<Edge>& edges, Vec3 origin) {
    const Edge e = edges[random.index(static_cast<std::uint32_t>(edges.size()))];
    const Vec3 a = mesh.positions[e.a], b = mesh.positions[e.b];
    const double s = 0.02 + 0.96 * random.uniform_double(); // an open mesh ends at its outer ring
    const auto mix = [&](float p, float q) {
        return static_cast<double>(p) + s * (static_cast<double>(q) - static_cast<double>(p));
    };
    return ray_to(random, origin, mix(a.x, b.x), mix(a.y, b.y), mix(a.z, b.z));
}

struct Fixture {
    Mesh mesh;
    Vec3 center;
    Vec3 reach; ///< origins lie at center + lift + reach * [-1,1]^3
    Vec3 lift;
};

Fixture sphere_fixture(float size, Vec3 offset) {
    const float r = 0.3f * size;
    return {closed_sphere(offset, size, 24), offset, {r, r, r}, {}};
}

Fixture plane_fixture(float size, Vec3 offset) {
    return {plane(offset, size, 12),
            offset,
            {0.4f * size, 0.4f * size, 0.3f * size},
            {0, 0, 0.4f * size}};
}

int edge_escapes(const Intersector& accel, const Fixture& f, int rays) {
    Random random(71);
    const std::vector<Edge> edges = shared_edges(f.mesh);
    int lost = 0;
    for (int i = 0; i < rays; ++i) {
        const Vec3 origin = f.center + f.lift + f.reach * random.point(-1, 1);
        const Ray ray = ray_to_edge(random, f.mesh, edges, origin);
        lost += !accel.closest(ray).valid();
        if (i % 16 == 0)
            lost += !accel.occluded(ray);
    }
    return lost;
}

int vertex_escapes(const Intersector& accel, const Fixture& f, int rays) {
    Random random(72);
    const std::vector<std::uint32_t> vertices = inner_vertices(f.mesh);
    int lost = 0;
    for (int i = 0; i < rays; ++i) {
        const Vec3 origin = f.center + f.lift + f.reach * random.point(-1, 1);
        const Vec3 v =
            f.mesh.positions[vertices[random.index(static_cast<std::uint32_t>(vertices.size()))]];
        lost += !accel
                     .closest(ray_to(random, origin, static_cast<double>(v.x),
                                     static_cast<double>(v.y), static_cast<double>(v.z)))
                     .valid();
    }
    return lost;
}

TEST_P(IntersectorWatertight, NoRayEscapesAtAnEdge) {
    for (const float size : sizes)
        for (const Vec3 offset : offsets) {
            const bool all = has_full_numbers(GetParam()) || (offset.x == 1e6f && size == 50);
            for (const Fixture& f : {sphere_fixture(size, offset), plane_fixture(size, offset)}) {
                const MeshView mesh = f.mesh.view();
                const auto accel = build(GeometryView{{&mesh, 1}, {}});
                EXPECT_EQ(edge_escapes(*accel, f, all ? 1000000 : 100000), 0)
                    << "size " << size << " offset " << offset.x;
            }
        }
}

TEST(IntersectorWatertightControl, SeesTheLeaksOfMoellerTrumbore) {
    // The table: 11 % of edge rays leak at offset 0, 0.3 % at 1e2. If this finds none, the tests
    // above are blind.
    for (const Vec3 offset : {offsets[0], offsets[1]}) {
        const Fixture f = sphere_fixture(50, offset);
        const MeshView mesh = f.mesh.view();
        const auto accel = make_intersector(AccelKind::sah, GeometryView{{&mesh, 1}, {}},
                                            {TriangleTest::moeller_trumbore});
        EXPECT_GT(edge_escapes(*accel, f, 200000), 20) << offset.x;
    }
}

TEST_P(IntersectorWatertight, NoRayEscapesAtAVertex) {
    const int rays = has_full_numbers(GetParam()) ? 100000 : 20000;
    const int limit = static_cast<int>(vertex_limit(GetParam().kind) * rays);
    for (const float size : sizes)
        for (const Vec3 offset : offsets)
            for (const Fixture& f : {sphere_fixture(size, offset), plane_fixture(size, offset)}) {
                const MeshView mesh = f.mesh.view();
                const auto accel = build(GeometryView{{&mesh, 1}, {}});
                EXPECT_LE(vertex_escapes(*accel, f, rays), limit)
                    << "size " << size << " offset " << offset.x;
            }
}

TEST_P(IntersectorWatertight, NoRandomRayEscapesAClosedMesh) {
    for (const Vec3 offset : offsets) {
        const Fixture f = sphere_fixture(50, offset);
        const MeshView mesh = f.mesh.view();
        const auto accel = build(GeometryView{{&mesh, 1}, {}});
        Random random(73);
        int lost = 0;
        for (int i = 0; i < 100000; ++i) {
            const Ray ray{f.center + f.reach * random.point(-1, 1), 0, random.direction(),
                          infinity};
            lost += !accel->closest(ray).valid();
        }
        EXPECT_EQ(lost, 0) << "offset " << offset.x;
    }
}

TEST_P(IntersectorWatertight, NoRayFromFarAwayPassesBetweenTriangles) {
    // From 1e3 to 1e6 away through the middle of a plane of 10: Möller–Trumbore loses 15 %.
    const Mesh mesh = plane({0, 0, 0}, 10, 12);
    const MeshView view = mesh.view();
    const auto accel = build(GeometryView{{&view, 1}, {}});
    Random random(74);
    for (const float distance : {1e3f, 1e4f, 1e6f}) {
        int lost = 0;
        for (int i = 0; i < 100000; ++i) {
            Vec3 back = random.direction();
            back.z = 0.3f + std::fabs(back.z);
            const Vec3 target{random.uniform(-4, 4), random.uniform(-4, 4), 0};
            const Vec3 origin = target + distance * normalize(back);
            lost += !accel->closest(Ray{origin, 0, target - origin, infinity}).valid();
        }
        // Embree's robust mode: none at 1e3 and 1e4, 8 of 1e5 at 1e6 (measured, 3.13.5).
        const bool excused = GetParam().kind == AccelKind::embree && distance == 1e6f;
        EXPECT_LE(lost, excused ? 50 : 0) << "distance " << distance;
    }
}

TEST_P(IntersectorWatertight, NoRayFromBesideALargeWallEscapesAtItsEdge) {
    // Origins at 1e-6 .. 1 of walls of 1900. This is where a tree that trusts tight boxes leaks.
    const Mesh room = box({-1000.3f, -900.7f, -1000.1f}, {1.1f, 1.3f, 899.9f});
    const MeshView view = room.view();
    const auto accel = build(GeometryView{{&view, 1}, {}});
    Random random(75);
    int lost = 0;
    for (int i = 0; i < 300000; ++i) {
        const float s = std::exp(random.uniform(-14, 0));
        const Vec3 origin{1.1f - s * random.uniform(0.01f, 1), 1.3f - s * random.uniform(0.01f, 1),
                          random.uniform(-100, 100)};
        Vec3 d{1.1f - origin.x, 1.3f - origin.y, s * random.uniform(-5, 5)};
        d.x *= 1 + random.uniform(-1, 1) * std::exp(random.uniform(-14, -2));
        lost += !accel->closest(Ray{origin, 0, normalize(d), infinity}).valid();
    }
    EXPECT_EQ(lost, 0);
}

} // namespace
} // namespace plumb::test
