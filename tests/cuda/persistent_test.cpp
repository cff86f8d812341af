/// \file  Persistent threads find what one thread a ray finds, whatever lane takes which ray.

#include "cuda/host_warp.h"

#include "accel/sah/build_compressed.h"
#include "tests/support/hard_scenes.h"
#include "tests/support/hits.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

namespace plumb::test {
namespace {

constexpr TriangleTest watertight = TriangleTest::watertight;

/// Rays, and how often each was asked for and stored.
struct CountedItems {
    std::vector<Ray> rays;
    mutable std::vector<Hit> hits{};
    mutable std::vector<int> asked{}, stored{};

    explicit CountedItems(std::vector<Ray> given)
        : rays(std::move(given)), hits(rays.size()), asked(rays.size()), stored(rays.size()) {}
    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(rays.size()); }
    [[nodiscard]] Ray ray(std::uint32_t i) const {
        ++asked.at(i);
        return rays.at(i);
    }
    void store(std::uint32_t i, const Hit& hit) const {
        ++stored.at(i);
        hits.at(i) = hit;
    }
};

/// Towards a unit cube and past it; every seventh is not valid, every fifth ends early.
std::vector<Ray> some_rays(std::size_t count) {
    Random random(151);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 origin = 3.0f * random.direction();
        Ray ray{origin, 0, random.point(-1.5f, 1.5f) - origin, infinity};
        if (i % 7 == 3)
            ray.tmin = -5; // would hit what is behind the origin
        if (i % 5 == 2)
            ray.tmax = random.uniform(0, 1);
        rays.push_back(ray);
    }
    return rays;
}

void expect_hits_of_single_rays(const CompressedView& tree, const std::vector<Ray>& rays) {
    const CountedItems items(rays);
    std::uint32_t taken = 0;
    trace_persistently_on_host<watertight>(tree, items, taken);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(items.asked[i], 1) << i << " of " << rays.size();
        ASSERT_EQ(items.stored[i], 1) << i << " of " << rays.size();
        ASSERT_TRUE(same_bits(items.hits[i], closest<watertight>(tree, rays[i]))) << i;
    }
}

TEST(Persistent, EveryRayIsTracedOnceHoweverManyThereAre) {
    const TestGeometry scene(displaced_sphere({0, 0, 0}, 1, 40));
    const CompressedTree tree = build_compressed(scene.view());
    for (const std::size_t count : {0u, 1u, 11u, 12u, 31u, 32u, 33u, 64u, 1000u, 20000u})
        expect_hits_of_single_rays(tree.view(), some_rays(count));
}

TEST(Persistent, OnHardScenesToo) {
    for (const NamedScene& scene : hard_scenes()) {
        SCOPED_TRACE(scene.name);
        const CompressedTree tree = build_compressed(scene.geometry.view());
        expect_hits_of_single_rays(tree.view(), some_rays(500));
    }
}

/// A warp that takes note of how many of its lanes work in each turn, and of its refills.
class WatchedWarp {
  public:
    template <class F> void each(F&& f) { warp_.each(f); }
    template <class F> std::uint32_t vote(F&& f) {
        const std::uint32_t votes = warp_.vote(f);
        turns.push_back(32 - ones(votes));
        return votes;
    }
    std::uint32_t take(std::uint32_t& counter, std::uint32_t n) {
        refills.push_back(n);
        return HostWarp<watertight>::take(counter, n);
    }

    std::vector<std::uint32_t> turns, refills;

  private:
    HostWarp<watertight> warp_;
};

TEST(Persistent, LanesThatAreDoneTakeOthersTogether) {
    const TestGeometry scene(displaced_sphere({0, 0, 0}, 1, 40));
    const CompressedTree tree = build_compressed(scene.view());
    const CountedItems items(some_rays(5000));
    std::uint32_t taken = 0;
    WatchedWarp warp;
    trace_persistently(warp, tree.view(), items, taken);
    EXPECT_EQ(warp.refills.front(), 32u);
    for (const std::uint32_t n : warp.refills)
        EXPECT_GE(n, refill_from);
    EXPECT_GE(taken, 5000u);
    EXPECT_LT(taken, 5000u + 32u); // nothing is taken once none is left
    std::uint64_t work = 0;
    for (const std::uint32_t n : warp.turns)
        work += n;
    EXPECT_GT(static_cast<double>(work), 0.6 * 32 * static_cast<double>(warp.turns.size()));
    EXPECT_GT(warp.refills.size(), 5000u / 32);
}

} // namespace
} // namespace plumb::test
