/// \file  Whole validations: sound pairs over many rays, threads, streams, what is kept.

#include "tests/accel/validate_support.h"

#include <algorithm>
#include <thread>

namespace plumb::test {
namespace {

struct NamedScene {
    const char* name;
    TestGeometry geometry;
};

std::vector<NamedScene> scenes() {
    std::vector<NamedScene> list;
    Random random(211);
    list.push_back({"mixed", mixed_scene(212)});
    list.push_back({"soup", TestGeometry(triangle_soup(random, 3000, 0.1f))});
    list.push_back({"needles", TestGeometry(needles(random, 1000, 1e-3f))});
    list.push_back({"closed sphere", TestGeometry(closed_sphere({0, 0, 0}, 1, 40))});
    list.push_back({"room", TestGeometry(box({-1.5f, -1.5f, -1.5f}, {1.5f, 1.5f, 1.5f}))});
    list.push_back({"copies", TestGeometry(repeated_triangle(500))});
    list.push_back({"displaced sphere", TestGeometry(displaced_sphere({0, 0, 0}, 1, 160))});
    return list;
}

/// Every fourth ray aims at a vertex, every fourth at an edge.
Ray any_ray(Random& random, const TestGeometry& scene, int i) {
    Ray ray = random_ray(random);
    if (i % 4 < 2)
        return ray;
    const auto meshes = static_cast<std::uint32_t>(scene.meshes().size());
    const Mesh& mesh = scene.meshes()[random.index(meshes)];
    const Triangle t =
        mesh.triangles[random.index(static_cast<std::uint32_t>(mesh.triangles.size()))];
    const Vec3 a = mesh.positions[t.a], b = mesh.positions[t.b];
    ray.direction = a + (i % 4 == 2 ? 0.0f : random.uniform()) * (b - a) - ray.origin;
    return length(ray.direction) > 0 ? ray : random_ray(random);
}

/// What first and second say of `count` rays, half of them any-hit queries.
ValidationReport compare(const NamedScene& scene, AccelKind first, AccelKind second, int count,
                         bool aimed) {
    const GeometryView view = scene.geometry.view();
    const auto a = make_intersector(first, view), b = make_intersector(second, view);
    const ValidatingIntersector both(view, *a, *b);
    const Intersector& queries = both;
    Random random(213);
    for (int i = 0; i < count; ++i) {
        const Ray ray = aimed ? any_ray(random, scene.geometry, i) : random_ray(random);
        if (i / 4 % 2 == 0)
            (void)queries.closest(ray);
        else
            (void)queries.occluded(ray);
    }
    return both.report();
}

TEST(ValidateIntersectors, NaiveAndSahAgreeOnEveryRay) {
    for (const NamedScene& scene : scenes()) {
        const ValidationReport r = compare(scene, AccelKind::naive, AccelKind::sah, 100000, true);
        EXPECT_EQ(r.count(Agreement::equal), 100000u) << scene.name;
        EXPECT_EQ(r.ray_count(), 100000u) << scene.name;
    }
}

TEST(ValidateIntersectors, NaiveAndEmbreeHaveNothingUnexplained) {
    for (const NamedScene& scene : scenes()) {
        const ValidationReport r =
            compare(scene, AccelKind::naive, AccelKind::embree, 100000, false);
        EXPECT_EQ(r.unexplained_count(), 0u) << scene.name;
        // Two arithmetics; of copies Embree may take another one, which depends on the processor.
        EXPECT_GT(r.count(Agreement::ulps) + r.count(Agreement::tie), 1000u) << scene.name;
        EXPECT_LT(r.worst_share, 1) << scene.name;
        EXPECT_EQ(r.unchecked, 0u) << scene.name;
    }
}

TEST(ValidateIntersectors, OfRaysAimedAtEdgesAndCornersOnlyEmbreeLosesAny) {
    // Robust Embree lets some rays through that are aimed exactly at vertices; naive none.
    const NamedScene scene{"displaced sphere", TestGeometry(displaced_sphere({0, 0, 0}, 1, 60))};
    const ValidationReport r = compare(scene, AccelKind::naive, AccelKind::embree, 200000, true);
    const auto& leaks = r.counts[static_cast<std::size_t>(Agreement::leak)];
    EXPECT_GT(leaks[2], 20u);
    EXPECT_LT(leaks[2], 500u);                  // below 0.5 % of those aimed at vertices
    EXPECT_EQ(leaks[2], r.unexplained_count()); // and nothing else is
    EXPECT_GT(r.count(Agreement::shared_edge), 1000u);
}

TEST(ValidateIntersectors, AnswersAreThoseOfTheFirst) {
    const TestGeometry scene = mixed_scene(214);
    const auto naive = make_intersector(AccelKind::naive, scene.view());
    const Defective broken(*naive, miss_always);
    const ValidatingIntersector both(scene.view(), *naive, broken);
    Random random(215);
    std::vector<Ray> rays(1000);
    std::generate(rays.begin(), rays.end(), [&] { return random_ray(random); });
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> found(rays.size());
    const Intersector& queries = both;
    queries.closest(rays, hits);
    queries.occluded(rays, found);
    std::size_t hit_count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit expected = naive->closest(rays[i]);
        hit_count += expected.valid() ? 1u : 0u;
        EXPECT_TRUE(same_bits(hits[i], expected));
        EXPECT_TRUE(same_bits(queries.closest(rays[i]), expected));
        EXPECT_EQ(found[i] != 0, expected.valid());
        EXPECT_EQ(queries.occluded(rays[i]), expected.valid());
    }
    // Streams are compared as single rays are: each hit was dropped in all four queries.
    const ValidationReport r = both.report();
    EXPECT_GT(hit_count, 100u);
    EXPECT_EQ(r.ray_count(), 4 * rays.size());
    EXPECT_EQ(r.rays[static_cast<std::size_t>(RayKind::bounce)], 2 * rays.size());
    EXPECT_EQ(r.rays[static_cast<std::size_t>(RayKind::shadow)], 2 * rays.size());
    EXPECT_EQ(r.count(Agreement::equal), 4 * (rays.size() - hit_count));
}

TEST(ValidateIntersectors, StreamsOfBothSidesAreCompared) {
    // A defect in the stream alone.
    class BrokenStream final : public Intersector {
      public:
        explicit BrokenStream(const Intersector& sound) : sound_(sound) {}
        using Intersector::occluded;
        [[nodiscard]] Hit closest(const Ray& ray) const override { return sound_.closest(ray); }
        [[nodiscard]] bool occluded(const Ray& ray) const override { return sound_.occluded(ray); }
        void closest(std::span<const Ray> rays, std::span<Hit> hits) const override {
            sound_.closest(rays, hits);
            hits[3] = {};
        }
        [[nodiscard]] AccelStats stats() const override { return {}; }

      private:
        const Intersector& sound_;
    };
    const TestGeometry scene(plane({0, 0, 0}, 2, 1));
    const auto naive = make_intersector(AccelKind::naive, scene.view());
    const BrokenStream broken(*naive);
    const std::vector<Ray> rays(5, Ray{{0.3f, 0.1f, 1}, 0, {0, 0, -1}, infinity});
    std::vector<Hit> hits(rays.size());
    const ValidatingIntersector second(scene.view(), *naive, broken),
        first(scene.view(), broken, *naive);
    static_cast<const Intersector&>(second).closest(rays, hits);
    EXPECT_TRUE(hits[3].valid());
    static_cast<const Intersector&>(first).closest(rays, hits);
    EXPECT_FALSE(hits[3].valid());
    constexpr auto miss = static_cast<std::size_t>(Agreement::miss);
    EXPECT_EQ(second.report().counts[miss][2], 1u);
    EXPECT_EQ(first.report().counts[miss][1], 1u);
}

TEST(ValidateIntersectors, CountsAndKeptRaysAreTheSameForAnyNumberOfThreads) {
    const TestGeometry scene = mixed_scene(216);
    const auto naive = make_intersector(AccelKind::naive, scene.view());
    const Defective broken(*naive, miss_always);
    std::vector<Ray> rays(20000);
    Random random(217);
    std::generate(rays.begin(), rays.end(), [&] { return random_ray(random); });
    ValidationOptions few;
    few.keep_unexplained = 50;
    few.is_camera_ray = [](const Ray& ray) { return ray.direction.x > 0; };
    const auto run = [&](std::size_t threads) {
        const ValidatingIntersector both(scene.view(), *naive, broken, few);
        std::vector<std::thread> all;
        for (std::size_t k = 0; k < threads; ++k)
            all.emplace_back([&, k] {
                for (std::size_t i = k; i < rays.size(); i += threads)
                    (void)static_cast<const Intersector&>(both).closest(rays[i]);
            });
        for (std::thread& t : all)
            t.join();
        return both.report();
    };
    const ValidationReport one = run(1), four = run(4);
    EXPECT_EQ(one.rays, four.rays);
    EXPECT_EQ(one.counts, four.counts);
    EXPECT_GT(one.rays[0], 5000u);
    EXPECT_GT(one.rays[1], 5000u);
    ASSERT_EQ(one.unexplained.size(), 50u);
    ASSERT_EQ(four.unexplained.size(), 50u);
    EXPECT_GT(one.unexplained_count(), 5000u);
    for (std::size_t i = 0; i < 50; ++i)
        EXPECT_EQ(one.unexplained[i].ray.direction, four.unexplained[i].ray.direction);
}

TEST(ValidateIntersectors, TheHistogramHoldsTheShifts) {
    const TestGeometry scene(plane({0, 0, 0}, 2, 1));
    const auto naive = make_intersector(AccelKind::naive, scene.view());
    const Ray ray{{0.3f, 0.1f, 2}, 0, {0, 0, -1}, infinity};
    int shift = 0;
    const Defective broken(*naive, [&shift](const Ray&, Hit hit) {
        hit.t = moved(hit.t, shift);
        return hit;
    });
    const ValidatingIntersector both(scene.view(), *naive, broken);
    for (shift = 0; shift <= 8; ++shift)
        (void)static_cast<const Intersector&>(both).closest(ray);
    const ValidationReport r = both.report();
    EXPECT_EQ(r.count(Agreement::equal), 1u);
    EXPECT_EQ(r.t_ulps, (UlpHistogram{0, 1, 1, 2, 4, 0}));
    EXPECT_EQ(r.uv_ulps, (UlpHistogram{8, 0, 0, 0, 0, 0}));
    EXPECT_EQ(r.worst_t_ulps, 8u);
}

} // namespace
} // namespace plumb::test
