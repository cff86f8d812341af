/// \file  Suite of every Intersector: hits against the brute-force oracle.

#include "tests/accel/intersector_suite.h"

#include <algorithm>
#include <array>

namespace plumb::test {
namespace {

class IntersectorAccuracy : public IntersectorTest {};
INSTANTIATE_TEST_SUITE_P(Every, IntersectorAccuracy, every_config(), config_name);

/// Möller–Trumbore is off by up to 2e-4 in position on needles.
class WatertightAccuracy : public IntersectorTest {};
INSTANTIATE_TEST_SUITE_P(Every, WatertightAccuracy, watertight_configs(), config_name);

/// Embree 3.13 misses triangles larger than about 1e12: its products overflow.
class OwnAccuracy : public IntersectorTest {};
INSTANTIATE_TEST_SUITE_P(Every, OwnAccuracy, own_configs(), config_name);

constexpr double ulp_of_one = 0x1p-23;

struct Double3 {
    double x, y, z;
};
Double3 widen(Vec3 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
Double3 edge_between(Double3 a, Double3 b) { return {b.x - a.x, b.y - a.y, b.z - a.z}; }
Double3 unit_cross(Double3 a, Double3 b) {
    const Double3 c{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    const double l = std::hypot(c.x, c.y, c.z);
    return {c.x / l, c.y / l, c.z / l};
}
double distance(Double3 a, Double3 b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

/// Barycentric point of a hit, in float as a renderer finds it.
Vec3 point_of(const TriangleVertices& t, float u, float v) {
    return (1 - u - v) * t.a + u * t.b + v * t.c;
}

TEST_P(IntersectorAccuracy, TUVPositionAndNormalAreWithin16UlpOf256Rays) {
    // 256 triangles of edge about 1, 3 apart; a ray at each, steeper than 17 degrees.
    Random random(61);
    Mesh mesh;
    std::vector<Ray> rays;
    while (rays.size() < 256) {
        const float x = 3 * static_cast<float>(rays.size() % 16) - 24;
        const float y = 3 * static_cast<float>(rays.size() / 16) - 24;
        const Vec3 cell{x, y, 0};
        const TriangleVertices t{cell + random.point(-1, 1), cell + random.point(-1, 1),
                                 cell + random.point(-1, 1)};
        const Vec3 n = cross(t.b - t.a, t.c - t.a);
        const Vec3 origin = cell + Vec3{random.uniform(-1, 1), random.uniform(-1, 1), 3};
        const Vec3 target = point_of(t, random.uniform(0.05f, 0.45f), random.uniform(0.05f, 0.45f));
        const Vec3 d = normalize(target - origin);
        if (length(n) < 0.3f || std::fabs(dot(n, d)) < 0.3f * length(n))
            continue;
        mesh.add_triangle(t.a, t.b, t.c);
        rays.push_back({origin, 0, d, infinity});
    }
    const TestGeometry scene(std::move(mesh));
    const auto accel = build(scene.view());
    // The scene is 48 wide: coordinates and t of up to 24 and 6 carry ulps of their own size.
    for (const Ray& ray : rays) {
        const Hit hit = accel->closest(ray);
        const ExactHit e = brute_force_closest(scene.view(), ray).value();
        ASSERT_TRUE(hit.valid());
        ASSERT_EQ(hit.geometry, e.geometry);
        ASSERT_EQ(hit.primitive, e.primitive);
        EXPECT_EQ(hit.instance, invalid_id);
        EXPECT_NEAR(static_cast<double>(hit.t), e.t, 16 * ulp_of_one * e.t);
        const double scale = std::max(1.0f, max_component(abs(ray.origin)));
        EXPECT_NEAR(static_cast<double>(hit.u), e.u, 16 * ulp_of_one);
        EXPECT_NEAR(static_cast<double>(hit.v), e.v, 16 * ulp_of_one);
        const TriangleVertices t = scene.view().vertices(hit.geometry, hit.primitive);
        const Double3 o = widen(ray.origin), d = widen(ray.direction);
        const Double3 p{o.x + e.t * d.x, o.y + e.t * d.y, o.z + e.t * d.z};
        EXPECT_LT(distance(widen(point_of(t, hit.u, hit.v)), p), 16 * ulp_of_one * scale);
        const Double3 a = widen(t.a),
                      n = unit_cross(edge_between(a, widen(t.b)), edge_between(a, widen(t.c)));
        const Vec3 normal = normalize(cross(t.b - t.a, t.c - t.a));
        EXPECT_LT(distance(widen(normal), n), 16 * ulp_of_one);
    }
}

/// How a hit compares with the oracle's.
enum class Verdict { same, explained, wrong };

/// A different answer is explained if rounding decides it: the hit that is missing or reported lies
/// within `slack` of an edge or silhouette, or both lie at the same t.
Verdict judge(const GeometryView& view, const Ray& ray, const Hit& hit, double slack) {
    const auto e = brute_force_closest(view, ray);
    if (!hit.valid())
        return !e ? Verdict::same : e->edge < slack ? Verdict::explained : Verdict::wrong;
    const auto reported = exact_hit(view, hit.geometry, hit.primitive, ray, slack);
    if (!reported)
        return Verdict::wrong;
    // Grazing hits are ill-conditioned in t: the limit is one of position, in world units.
    const double tolerance = 2e-5 / static_cast<double>(length(ray.direction));
    if (std::fabs(reported->t - static_cast<double>(hit.t)) > tolerance && reported->edge > slack)
        return Verdict::wrong;
    if (e && e->geometry == hit.geometry && e->primitive == hit.primitive)
        return Verdict::same;
    if (e && std::fabs(e->t - reported->t) <= tolerance)
        return Verdict::explained;
    const bool missed_nearer = e && e->t < reported->t;
    if (missed_nearer)
        return e->edge < slack ? Verdict::explained : Verdict::wrong;
    return reported->edge < slack ? Verdict::explained : Verdict::wrong;
}

struct Tally {
    int hits = 0, explained = 0, wrong = 0;
};

Tally compare_with_oracle(const Intersector& accel, const GeometryView& view, std::uint64_t seed,
                          int rays, double slack) {
    Random random(seed);
    Tally tally;
    for (int i = 0; i < rays; ++i) {
        const Ray ray = random_ray(random);
        const Hit hit = accel.closest(ray);
        const Verdict verdict = judge(view, ray, hit, slack);
        tally.hits += hit.valid();
        tally.explained += verdict == Verdict::explained;
        tally.wrong += verdict == Verdict::wrong;
    }
    return tally;
}

TEST_P(IntersectorAccuracy, ClosestHitMatchesBruteForceOnRandomTriangles) {
    Random random(62);
    const TestGeometry scene(triangle_soup(random, 800, 0.1f));
    const Tally tally = compare_with_oracle(*build(scene.view()), scene.view(), 63, 2500, 1e-4);
    EXPECT_EQ(tally.wrong, 0);
    EXPECT_LE(tally.explained, 6);
    EXPECT_GT(tally.hits, 600);
}

TEST_P(WatertightAccuracy, ClosestHitMatchesBruteForceOnNeedles) {
    Random random(64);
    const TestGeometry scene(needles(random, 800, 1e-2f));
    const Tally tally = compare_with_oracle(*build(scene.view()), scene.view(), 65, 2500, 1e-3);
    EXPECT_EQ(tally.wrong, 0);
    EXPECT_LE(tally.explained, 12);
    EXPECT_GT(tally.hits, 400);
}

TEST_P(IntersectorAccuracy, ClosestHitMatchesBruteForceOnSpheresAndMeshesTogether) {
    const TestGeometry scene = mixed_scene(66);
    const Tally tally = compare_with_oracle(*build(scene.view()), scene.view(), 67, 2500, 1e-4);
    // The scene holds needles, where Möller–Trumbore is off.
    EXPECT_LE(tally.wrong, GetParam().test == TriangleTest::moeller_trumbore ? 3 : 0);
    EXPECT_LE(tally.explained, 6);
    EXPECT_GT(tally.hits, 600);
}

TEST_P(IntersectorAccuracy, ClosestHitMatchesBruteForceOnAGridOfSpheres) {
    TestGeometry scene;
    for (Sphere s : sphere_grid(9, 0.4f)) {
        s.center = 0.2f * s.center - Vec3{0.8f, 0.8f, 0.8f};
        s.radius *= 0.2f;
        scene.add(s);
    }
    const Tally tally = compare_with_oracle(*build(scene.view()), scene.view(), 68, 2500, 1e-9);
    EXPECT_EQ(tally.wrong, 0);
    EXPECT_EQ(tally.explained, 0);
    EXPECT_GT(tally.hits, 1200);
}

TEST_P(OwnAccuracy, CoordinatesUpToTheLimitAreTraced) {
    // Boxes overflow float areas above 1e19; the centre of a triangle must still be hit.
    Random random(69);
    Mesh mesh;
    constexpr float big = 1e17f;
    for (int i = 0; i < 40; ++i) {
        const float x = 0.04f * static_cast<float>(i) * max_coordinate - 0.8f * max_coordinate;
        mesh.add_triangle({x - big, -big, 0}, {x + big, -big, 0}, {x, big, big});
    }
    const TestGeometry scene(std::move(mesh));
    const auto accel = build(scene.view());
    for (std::uint32_t i = 0; i < 40; ++i) {
        const TriangleVertices t = scene.view().vertices(0, i);
        const Vec3 target = point_of(t, 0.25f, 0.3f);
        const Ray ray{target - Vec3{0, 0, 3 * big}, 0, {0, 0, 1}, infinity};
        const Hit hit = accel->closest(ray);
        EXPECT_TRUE(hit.valid()) << i;
        EXPECT_EQ(brute_force_closest(scene.view(), ray).has_value(), hit.valid());
    }
}

} // namespace
} // namespace plumb::test
