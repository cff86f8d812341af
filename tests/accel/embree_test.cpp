/// \file  What Embree's configurations and the benchmark's bare loop add to the common suite.
#include "accel/embree/embree_intersector.h"
#include "accel/embree/embree_peer.h"
#include "tests/support/meshes.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>

namespace plumb::test {
namespace {

std::vector<Ray> random_rays(std::size_t count) {
    Random random(3);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i)
        rays.push_back({random.point(-2, 2), 0, random.direction(), infinity});
    return rays;
}

std::vector<EmbreeOptions> all_options(int packet) {
    std::vector<EmbreeOptions> options;
    for (const bool robust : {false, true})
        for (const BuildQuality quality :
             {BuildQuality::fast, BuildQuality::medium, BuildQuality::high})
            options.push_back({robust, quality, packet, 1});
    return options;
}

/// Hits that differ in the triangle, or in t by more than 1e-5 of it.
std::size_t disagreements(std::span<const Hit> a, std::span<const Hit> b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const bool same = a[i].geometry == b[i].geometry && a[i].primitive == b[i].primitive &&
                          (!a[i].valid() || std::fabs(a[i].t - b[i].t) <= 1e-5f * b[i].t);
        count += same ? 0u : 1u;
    }
    return count;
}

std::vector<Hit> closest_of(const Intersector& intersector, std::span<const Ray> rays) {
    std::vector<Hit> hits(rays.size());
    intersector.closest(rays, hits);
    return hits;
}

TEST(Embree, EveryConfigurationFindsTheHitsOfNaive) {
    const TestGeometry scene = mixed_scene(8); // with spheres
    std::vector<Ray> rays = random_rays(4099); // the last packet is not full
    rays[5].direction = {};                    // invalid: a miss in its packet
    const std::vector<Hit> expected =
        closest_of(*make_intersector(AccelKind::naive, scene.view()), rays);
    ASSERT_TRUE(std::any_of(expected.begin(), expected.end(),
                            [](const Hit& hit) { return hit.geometry == 4; }));
    for (const int packet : {1, 16})
        for (const EmbreeOptions& options : all_options(packet)) {
            const auto embree = make_embree_intersector(scene.view(), options);
            const std::vector<Hit> hits = closest_of(*embree, rays);
            // Rays through edges, and equal distances.
            EXPECT_LE(disagreements(hits, expected), 4u);
            EXPECT_FALSE(hits[5].valid());
            std::vector<std::uint8_t> found(rays.size(), 2);
            embree->occluded(rays, found);
            std::size_t wrong = 0;
            for (std::size_t i = 0; i < rays.size(); ++i)
                wrong += (found[i] != 0) != expected[i].valid() ? 1u : 0u;
            EXPECT_LE(wrong, 4u);
        }
}

TEST(Embree, RefusesPacketsOfOtherWidths) {
    const TestGeometry scene(box({0, 0, 0}, {1, 1, 1}));
    for (const int packet : {0, 4, 17})
        EXPECT_THROW(static_cast<void>(
                         make_embree_intersector(scene.view(), EmbreeOptions{.packet = packet})),
                     std::runtime_error);
}

TEST(Embree, HigherQualitySplitsMore) {
    Random random(1);
    const TestGeometry scene(needles(random, 20'000, 0.01f));
    const auto bytes = [&](BuildQuality quality) {
        return make_embree_intersector(scene.view(), EmbreeOptions{false, quality, 1, 1})
            ->stats()
            .bytes;
    };
    EXPECT_GT(bytes(BuildQuality::high), bytes(BuildQuality::medium));
    BuildOptions options;
    options.quality = BuildQuality::fast;
    EXPECT_NE(make_embree_intersector(scene.view(), options)->stats().bytes,
              make_embree_intersector(scene.view(), BuildOptions{})->stats().bytes);
}

TEST(EmbreePeer, GivesTheAnswersOfTheIntersector) {
    const TestGeometry scene = mixed_scene(9);
    const std::vector<Ray> rays = random_rays(1003);
    for (const EmbreeOptions& options : all_options(1)) {
        const std::vector<Hit> expected =
            closest_of(*make_embree_intersector(scene.view(), options), rays);
        const EmbreePeer peer(scene.view(), options);
        for (const int packet : {1, 16}) {
            const EmbreeRays closest(rays, false, packet), any(rays, true, packet);
            std::vector<Hit> hits(rays.size()), found(rays.size());
            EXPECT_EQ(peer.trace(closest, hits), peer.trace(closest));
            EXPECT_EQ(peer.trace(any, found), peer.trace(any));
            EXPECT_LE(disagreements(hits, expected), 2u);
            std::size_t wrong = 0;
            for (std::size_t i = 0; i < rays.size(); ++i)
                wrong += found[i].valid() != expected[i].valid() ? 1u : 0u;
            EXPECT_LE(wrong, 2u);
            EXPECT_EQ(closest.size(), rays.size());
            EXPECT_TRUE(any.any_hit());
        }
    }
}

TEST(EmbreePeer, ChecksumTellsOneRayFromAnother) {
    const TestGeometry scene(displaced_sphere({0, 0, 0}, 1, 40));
    const EmbreePeer peer(scene.view(), {});
    std::vector<Ray> rays = random_rays(100);
    const std::uint64_t sum = peer.trace(EmbreeRays(rays, false, 1));
    rays[50] = {{0, 0, 0}, 0, {0, 0.5f, 1}, infinity};
    EXPECT_NE(peer.trace(EmbreeRays(rays, false, 1)), sum);
}

TEST(EmbreePeer, RaysThatStartOnASurfaceDoNotHitIt) {
    // Denormals count as zero while it traces, and Embree takes t >= tnear: with tnear the smallest
    // denormal, robust scenes report the wall at t = 0.
    const TestGeometry scene(box({-1, 0, -1}, {1, 2, 1}));
    std::vector<Ray> rays;
    Random random(4);
    for (int i = 0; i < 1000; ++i)
        rays.push_back({{-1, random.uniform(0.1f, 1.9f), random.uniform(-0.9f, 0.9f)},
                        0,
                        {1, random.uniform(-0.4f, 0.4f), random.uniform(-0.4f, 0.4f)},
                        0.01f});
    for (const bool robust : {false, true})
        for (const int packet : {1, 16}) {
            const EmbreePeer peer(scene.view(), {.robust = robust});
            std::vector<Hit> hits(rays.size());
            static_cast<void>(peer.trace(EmbreeRays(rays, true, packet), hits));
            EXPECT_TRUE(
                std::none_of(hits.begin(), hits.end(), [](const Hit& hit) { return hit.valid(); }))
                << robust << packet;
        }
}

TEST(EmbreePeer, LeavesTheThreadsDenormalsAlone) {
    const TestGeometry scene(box({0, 0, 0}, {1, 1, 1}));
    const EmbreePeer peer(scene.view(), {});
    static_cast<void>(peer.trace(EmbreeRays(random_rays(16), false, 1)));
    volatile float denormal = std::numeric_limits<float>::denorm_min();
    EXPECT_GT(denormal * 2, 0.0f);
}

} // namespace
} // namespace plumb::test
