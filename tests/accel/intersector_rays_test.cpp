/// \file  Suite of every Intersector: invalid and inactive rays, limits, any-hit, streams, ties.

#include "tests/accel/intersector_suite.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>

namespace plumb::test {
namespace {

class IntersectorRays : public IntersectorTest {};
INSTANTIATE_TEST_SUITE_P(Every, IntersectorRays, every_config(), config_name);

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Every way in which a ray that would hit the middle of the scene can be broken.
std::vector<Ray> invalid_rays() {
    const Ray good{{0.1f, 0.2f, 4}, 0, {0.01f, -0.02f, -1}, 100};
    std::vector<Ray> rays;
    for (const float bad : {nan, -nan, infinity, -infinity, 1e19f, -1e38f})
        for (int axis = 0; axis < 3; ++axis) {
            rays.push_back(good);
            rays.back().origin[axis] = bad;
            rays.push_back(good);
            rays.back().direction[axis] = bad;
        }
    for (const Vec3 zero : {Vec3{0, 0, 0}, Vec3{-0.0f, 0, -0.0f}, Vec3{0, 1e-39f, -1e-45f}}) {
        rays.push_back(good);
        rays.back().direction = zero;
    }
    using Limits = std::array<float, 2>;
    for (const auto& [tmin, tmax] :
         {Limits{nan, 100}, Limits{0, nan}, Limits{nan, nan}, Limits{5, 4}, Limits{-1, 100},
          Limits{-infinity, 100}, Limits{0, -1}, Limits{0, -infinity}, Limits{infinity, 0},
          Limits{infinity, infinity}}) {
        rays.push_back(good);
        rays.back().tmin = tmin;
        rays.back().tmax = tmax;
    }
    return rays;
}

TEST_P(IntersectorRays, InvalidRaysMiss) {
    const TestGeometry scene = mixed_scene(81);
    const auto accel = build(scene.view());
    for (const Ray& ray : invalid_rays()) {
        EXPECT_TRUE(is_miss(accel->closest(ray))) << ray.tmin << ' ' << ray.tmax;
        EXPECT_FALSE(accel->occluded(ray));
    }
}

TEST_P(IntersectorRays, ASignedZeroIsAZero) {
    // tmin = -0 and directions with -0 are valid: the same bits as with +0, and the oracle's hit.
    const TestGeometry scene = mixed_scene(82);
    const auto accel = build(scene.view());
    Random random(83);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        Ray plus{random.point(-1, 1), 0, {0, 0, 0}, infinity};
        plus.direction[i % 3] = i % 2 == 0 ? 1.0f : -1.0f;
        Ray minus = plus;
        minus.tmin = -0.0f;
        for (int axis = 0; axis < 3; ++axis)
            if (axis != i % 3)
                minus.direction[axis] = -0.0f;
        const Hit a = accel->closest(plus), b = accel->closest(minus);
        EXPECT_TRUE(same_bits(a, b)) << i;
        EXPECT_EQ(accel->occluded(minus), b.valid());
        hits += a.valid();
    }
    EXPECT_GT(hits, 500);
}

TEST_P(IntersectorRays, DirectionsHitDownToTheSmallestThatIsValid) {
    TestGeometry scene;
    scene.add(Sphere{{0, 0, 2}, 1});
    Mesh wall;
    wall.add_triangle({-1, -1, 0.5f}, {1, -1, 0.5f}, {0, 1, 0.5f});
    scene.add(std::move(wall));
    const auto accel = build(scene.view());
    // Embree takes 1e-18 for the smallest (accel/embree/README.md).
    const float smallest = GetParam().kind == AccelKind::embree ? 1e-17f : min_direction;
    Ray ray{{0, 0, 0}, 0, {0, 0, smallest}, infinity};
    ASSERT_TRUE(is_valid(ray));
    EXPECT_FLOAT_EQ(accel->closest(ray).t, 0.5f / smallest);
    EXPECT_TRUE(accel->occluded(ray));
    ray.direction.z = std::nextafter(min_direction, 0.0f);
    EXPECT_FALSE(is_valid(ray));
}

double median_seconds(const Intersector& accel, const std::vector<Ray>& rays) {
    std::array<double, 7> seconds{};
    for (double& s : seconds) {
        const auto start = std::chrono::steady_clock::now();
        int hits = 0;
        for (int repeat = 0; repeat < 4; ++repeat)
            for (const Ray& ray : rays)
                hits += accel.closest(ray).valid();
        s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        EXPECT_GE(hits, 0); // the loop must not be optimised away
    }
    std::sort(seconds.begin(), seconds.end());
    return seconds[seconds.size() / 2];
}

TEST_P(IntersectorRays, InvalidRaysTakeAtMostTwoAndAHalfTimesTheTimeOfValidOnes) {
    const TestGeometry scene = mixed_scene(84);
    const auto accel = build(scene.view());
    Random random(85);
    const std::vector<Ray> broken = invalid_rays();
    std::vector<Ray> valid, invalid;
    for (std::size_t i = 0; i < 5000; ++i) {
        valid.push_back(random_ray(random));
        invalid.push_back(broken[i % broken.size()]);
    }
    EXPECT_LE(median_seconds(*accel, invalid), 2.5 * median_seconds(*accel, valid));
}

TEST_P(IntersectorRays, InactiveRaysInAStreamChangeNothing) {
    const TestGeometry scene = mixed_scene(86);
    const auto accel = build(scene.view());
    const Ray inactive{{0, 0, 0}, infinity, {0, 0, 1}, 0};
    Random random(87);
    std::vector<Ray> rays, mixed;
    for (int i = 0; i < 1000; ++i) {
        rays.push_back(random_ray(random));
        mixed.push_back(rays.back());
        if (random.index(2) == 0)
            mixed.push_back(inactive);
    }
    const Hit stale{1, 2, 3, 4, 5, 6}; // what a caller's buffer holds must not matter either
    std::vector<Hit> hits(rays.size(), stale), mixed_hits(mixed.size(), stale);
    accel->closest(rays, hits);
    accel->closest(mixed, mixed_hits);
    std::size_t k = 0;
    for (std::size_t i = 0; i < mixed.size(); ++i) {
        if (mixed[i].tmax == 0 && mixed[i].tmin == infinity) {
            EXPECT_TRUE(is_miss(mixed_hits[i]));
            continue;
        }
        EXPECT_TRUE(same_bits(mixed_hits[i], hits[k]));
        EXPECT_TRUE(same_bits(hits[k], accel->closest(rays[k]))) << "stream and single ray";
        ++k;
    }
    EXPECT_EQ(k, rays.size());
    accel->closest(std::span<const Ray>{}, std::span<Hit>{});
}

TEST_P(IntersectorRays, OccludedIsTheSameAsAClosestHit) {
    const TestGeometry scene = mixed_scene(88);
    const auto accel = build(scene.view());
    Random random(89);
    int differ = 0, hits = 0;
    for (int i = 0; i < 100000; ++i) {
        Ray ray = random_ray(random);
        Hit hit = accel->closest(ray);
        differ += accel->occluded(ray) != hit.valid();
        hits += hit.valid();
        if (!hit.valid())
            continue;
        ray.tmax = i % 2 == 0 ? hit.t : std::nextafter(hit.t, 0.0f);
        if (ray.tmin <= ray.tmax)
            differ += accel->occluded(ray) != accel->closest(ray).valid();
    }
    EXPECT_EQ(differ, 0);
    EXPECT_GT(hits, 30000);
}

TEST_P(IntersectorRays, TmaxIsInclusiveAndTminExclusive) {
    const TestGeometry scene = mixed_scene(90);
    const auto accel = build(scene.view());
    Random random(91);
    int wrong = 0, hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Ray ray = random_ray(random);
        const Hit hit = accel->closest(ray);
        if (!hit.valid())
            continue;
        ++hits;
        wrong += !(hit.t > ray.tmin && hit.t <= ray.tmax);
        Ray cut = ray;
        cut.tmax = hit.t;
        wrong += !same_bits(accel->closest(cut), hit);
        wrong += !accel->occluded(cut);
        cut.tmax = std::nextafter(hit.t, 0.0f);
        if (cut.tmax >= cut.tmin) {
            wrong += accel->closest(cut).valid();
            wrong += accel->occluded(cut);
        }
        cut = ray;
        cut.tmin = std::nextafter(hit.t, 0.0f);
        if (cut.tmin > ray.tmin)
            wrong += !same_bits(accel->closest(cut), hit);
        cut.tmin = hit.t;
        const Hit next = accel->closest(cut);
        wrong += next.valid() && !(next.t > hit.t);
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(hits, 6000);
}

/// The write-up's tie rule; Embree's own order decides ties there.
class OwnRays : public IntersectorTest {};
INSTANTIATE_TEST_SUITE_P(Every, OwnRays, own_configs(), config_name);

TEST_P(OwnRays, TiesGoToTheLowestGeometryAndPrimitive) {
    // Three meshes with the same 50 triangles, the second and third in reverse order, and every
    // triangle of the first twice.
    Random random(92);
    const Mesh soup = triangle_soup(random, 50, 0.5f);
    Mesh twice, reversed;
    for (const Triangle t : soup.triangles)
        for (int copy = 0; copy < 2; ++copy)
            twice.add_triangle(soup.positions[t.a], soup.positions[t.b], soup.positions[t.c]);
    reversed.positions = soup.positions;
    reversed.triangles.assign(soup.triangles.rbegin(), soup.triangles.rend());
    TestGeometry scene;
    scene.add(reversed);
    scene.add(twice);
    scene.add(soup);
    TestGeometry other;
    other.add(twice);
    other.add(reversed);
    for (int i = 0; i < 2; ++i) {
        scene.add(Sphere{{0, 0, 0}, 0.4f});
        other.add(Sphere{{0, 0, 0}, 0.4f});
    }
    const auto first = build(scene.view()), second = build(other.view());
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Ray ray = random_ray(random);
        const Hit a = first->closest(ray), b = second->closest(ray);
        ASSERT_EQ(a.t, b.t);
        if (!a.valid())
            continue;
        ++hits;
        if (scene.view().is_sphere(a.geometry)) {
            ASSERT_EQ(a.primitive, 0u);
            ASSERT_EQ(b.primitive, 0u);
            continue;
        }
        ASSERT_EQ(a.geometry, 0u);
        ASSERT_EQ(b.geometry, 0u);
        ASSERT_EQ(b.primitive % 2, 0u);
        ASSERT_EQ(b.primitive / 2, 49 - a.primitive);
    }
    EXPECT_GT(hits, 5000);
}

} // namespace
} // namespace plumb::test
