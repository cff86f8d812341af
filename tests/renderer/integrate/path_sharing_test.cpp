/// \file  What a block of paths shares: weights against formulas in double, and what has none.

#include "renderer/integrate/path_sharing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace plumb::test {
namespace {

/// Rays are blocked where a test says so.
class Blocker final : public Intersector {
  public:
    using Intersector::closest, Intersector::occluded;
    explicit Blocker(std::function<bool(const Ray&)> blocks) : blocks_(std::move(blocks)) {}
    [[nodiscard]] Hit closest(const Ray&) const override { return {}; }
    [[nodiscard]] bool occluded(const Ray& ray) const override { return blocks_(ray); }
    [[nodiscard]] AccelStats stats() const override { return {}; }

  private:
    std::function<bool(const Ray&)> blocks_;
};
const Blocker nothing([](const Ray&) { return false; });

struct SharedPath {
    Vec3 first{}, geometric{0, 0, 1}, shading{0, 0, 1};
    Rgb reflectance{1, 1, 1};
    Vec3 second{0, 0, 1}, second_normal{0, 0, -1};
    bool met_nothing = false, alike = true;
    Rgb own{1, 1, 1}, tail{1, 1, 1};
};
using Block = std::vector<SharedPath>;
using Batch = std::vector<Block>;

struct Outcome {
    std::vector<Rgb> radiance;
    std::size_t rays = 0;
};

void add(const SharedPath& path, std::size_t slot, PathLanes& lanes, PathSharing& sharing) {
    lanes.slot[slot] = static_cast<std::uint32_t>(slot);
    lanes.radiance.set(slot, {});
    if (path.met_nothing)
        return;
    lanes.position.set(slot, path.first);
    lanes.error.set(slot, {});
    lanes.geometric.set(slot, normalize(path.geometric));
    lanes.shading.set(slot, normalize(path.shading));
    lanes.reflectance.set(slot, path.reflectance);
    sharing.leave_first(lanes, lanes.shading, slot);
    sharing.set_own(slot, path.own);
    lanes.position.set(slot, path.second);
    lanes.geometric.set(slot, normalize(path.second_normal));
    sharing.reach_second(lanes, slot, path.alike);
    sharing.add(slot, path.tail);
}

/// Batches of blocks one after the other through the same object; the outcome of the last.
Outcome outcome_of(const std::vector<Batch>& batches, HemisphereSampling hemisphere,
                   const Intersector& intersector = nothing) {
    const auto lanes = std::make_unique<PathLanes>();
    const auto sharing = std::make_unique<PathSharing>();
    Outcome outcome;
    for (const Batch& blocks : batches) {
        sharing->clear(max_lanes);
        std::size_t count = 0;
        for (const Block& block : blocks) {
            for (const SharedPath& path : block)
                add(path, count++, *lanes, *sharing);
            sharing->end_group(count);
        }
        outcome.rays = sharing->share(intersector, hemisphere, *lanes);
        outcome.radiance.clear();
        for (std::size_t i = 0; i < count; ++i)
            outcome.radiance.push_back(lanes->radiance[i]);
    }
    return outcome;
}

std::vector<Rgb> share(const Block& block, HemisphereSampling hemisphere,
                       const Intersector& intersector = nothing) {
    return outcome_of({{block}}, hemisphere, intersector).radiance;
}

constexpr HemisphereSampling hemispheres[] = {HemisphereSampling::cosine,
                                              HemisphereSampling::uniform};

void expect_near(Rgb value, Rgb expected, const char* what = "") {
    EXPECT_NEAR(value.r, expected.r, 1e-5f * expected.r) << what;
    EXPECT_NEAR(value.g, expected.g, 1e-5f * expected.g) << what;
    EXPECT_NEAR(value.b, expected.b, 1e-5f * expected.b) << what;
}

/// Three places that see each other's second vertices under other angles and distances.
Block three_paths() {
    Block block(3);
    block[0].shading = {0.3f, 0.1f, 1};
    block[0].reflectance = {0.8f, 0.5f, 0.2f};
    block[0].second = {0.4f, -0.3f, 1.1f};
    block[0].second_normal = {0.2f, 0.3f, -1};
    block[0].tail = {3, 1, 2};
    block[1].first = {0.7f, 0.2f, -0.1f};
    block[1].geometric = {-0.2f, 0.1f, 1};
    block[1].reflectance = {0.3f, 0.9f, 0.6f};
    block[1].second = {-0.6f, 0.8f, 1.7f};
    block[1].second_normal = {0, -0.4f, -1};
    block[1].tail = {1, 4, 0.5f};
    block[2].first = {-0.3f, 0.9f, 0.3f};
    block[2].shading = {0.1f, -0.2f, 1};
    block[2].reflectance = {0.5f, 0.7f, 0.1f};
    block[2].second = {0.9f, 0.6f, 0.8f};
    block[2].second_normal = {-0.8f, 0, -1};
    block[2].tail = {0, 2, 5};
    return block;
}

double cosine(Vec3 a, Vec3 b) {
    const auto d = [](float x, float y) { return static_cast<double>(x) * static_cast<double>(y); };
    const auto product = [&](Vec3 u, Vec3 v) { return d(u.x, v.x) + d(u.y, v.y) + d(u.z, v.z); };
    return product(a, b) / std::sqrt(product(a, a) * product(b, b));
}

/// The balance heuristic of Bekaert et al.: what k gets of t's rest is f_k G(k, t) over the sum of
/// all densities at t's second vertex, here each without its 1 / pi.
std::vector<Rgb> by_formula(const Block& block, HemisphereSampling hemisphere) {
    std::vector<Rgb> sum(block.size());
    for (const SharedPath& t : block) {
        std::vector<double> leaving, geometry; // cosine; cosine there over the squared distance
        double densities = 0;
        for (const SharedPath& k : block) {
            const Vec3 d = t.second - k.first;
            leaving.push_back(cosine(d, k.shading));
            geometry.push_back(cosine(-d, t.second_normal) / static_cast<double>(dot(d, d)));
            const double per_angle =
                hemisphere == HemisphereSampling::cosine ? leaving.back() : 0.5; // over pi
            densities += per_angle * geometry.back();
        }
        for (std::size_t k = 0; k < block.size(); ++k)
            sum[k] = sum[k] + block[k].reflectance * t.tail *
                                  static_cast<float>(leaving[k] * geometry[k] / densities);
    }
    return sum;
}

TEST(PathSharing, EachPixelGetsTheBalanceHeuristicsShare) {
    for (const HemisphereSampling hemisphere : hemispheres) {
        const Outcome outcome = outcome_of({{three_paths()}}, hemisphere);
        const std::vector<Rgb> expected = by_formula(three_paths(), hemisphere);
        for (std::size_t k = 0; k < 3; ++k)
            expect_near(outcome.radiance[k], expected[k]);
        EXPECT_EQ(outcome.rays, 6u); // none for a path's own second vertex
    }
}

TEST(PathSharing, WhatIsBlockedGetsNothingAndHasNoDensity) {
    // Nothing but their own second vertices: f / p = reflectance x 2 cos of uniform directions.
    const Blocker everything([](const Ray&) { return true; });
    const Block block = three_paths();
    const std::vector<Rgb> alone = share(block, HemisphereSampling::uniform, everything);
    for (std::size_t k = 0; k < 3; ++k) {
        const auto both =
            static_cast<float>(2 * cosine(block[k].second - block[k].first, block[k].shading));
        expect_near(alone[k], block[k].reflectance * block[k].tail * both);
    }
    // Without the third, the other two are as if it were not there.
    const Vec3 third = block[2].first, its_second = block[2].second;
    const Blocker around_third([&](const Ray& ray) {
        const Vec3 end = ray.origin + ray.direction;
        return dot(end - third, end - third) < 1e-8f ||
               dot(ray.origin - its_second, ray.origin - its_second) < 1e-8f;
    });
    const std::vector<Rgb> shared = share(block, HemisphereSampling::cosine, around_third);
    const std::vector<Rgb> expected = by_formula({block[0], block[1]}, HemisphereSampling::cosine);
    expect_near(shared[0], expected[0]);
    expect_near(shared[1], expected[1]);
}

/// The second path of a pair found what the first cannot have chosen: it keeps it, as though alone.
TEST(PathSharing, VerticesThatAPathCannotChooseAreNotItsOwn) {
    const SharedPath finder{.first = {0.5f, 0, 0}, .second = {0.8f, 0, 0.6f}, .tail = {2, 3, 4}};
    SharedPath other{.first = {0, 0, 0}, .tail = {}};
    EXPECT_GT(share({other, finder}, HemisphereSampling::cosine)[0].r, 0.1f);
    struct Case {
        const char* what;
        SharedPath other, finder;
    };
    std::vector<Case> cases(5, {"below the geometric normal", other, finder});
    cases[0].other.geometric = {-0.9f, 0, 0.5f}; // the shading normal is above
    cases[1].what = "below the shading normal";
    cases[1].other.shading = {-0.9f, 0, 0.5f};
    cases[2].what = "behind the second vertex";
    cases[2].finder.second_normal = {1, 0, -0.3f};
    cases[2].finder.first = {1, 0, 0};
    cases[3].what = "nothing is reflected";
    cases[3].other.reflectance = {};
    cases[4].what = "nearer than floats can weigh";
    cases[4].other.first = {0, 0, -1e-20f};
    cases[4].finder.first = {-0.3f, 0, -0.6f};
    cases[4].finder.second = {};
    for (const Case& c : cases)
        for (const HemisphereSampling hemisphere : hemispheres) {
            const Outcome outcome = outcome_of({Batch{{c.other, c.finder}}}, hemisphere);
            EXPECT_EQ(outcome.radiance[0], (Rgb{})) << c.what;
            expect_near(outcome.radiance[1], share({c.finder}, hemisphere)[0], c.what);
            EXPECT_EQ(outcome.rays, 0u) << c.what;
        }
}

/// Where it matters whence the second vertex is seen, each path has its own, weighted by it.
TEST(PathSharing, SecondVerticesThatLookOtherwiseFromElsewhereAreNotShared) {
    Block block = three_paths();
    block[1].alike = false;
    block[1].own = {0.3f, 0.2f, 0.7f};
    Block others = block;
    others[1].tail = {};
    // After a batch that shared them.
    const Outcome all = outcome_of({{three_paths()}, {block}}, HemisphereSampling::cosine);
    const Outcome without = outcome_of({{others}}, HemisphereSampling::cosine);
    expect_near(all.radiance[0], without.radiance[0]);
    expect_near(all.radiance[1], without.radiance[1] + block[1].own * block[1].tail);
    expect_near(all.radiance[2], without.radiance[2]);
    EXPECT_EQ(all.rays, without.rays);
}

/// Alike in all, so that every weight is the same: however near the second vertices are, each pixel
/// has one. The sum of the densities overflows from 1e-18 on, each of them soon after, then the
/// squared distance has no digits left.
TEST(PathSharing, AtAnyDistanceEachPixelHasItsPart) {
    for (const HemisphereSampling hemisphere : hemispheres)
        for (const std::size_t paths : {1u, 4u, 16u})
            for (int exponent = -149; exponent <= 40; ++exponent) {
                SharedPath path;
                path.second = {0, 0, std::ldexp(1.0f, exponent)};
                path.own = Rgb{1, 1, 1} * (hemisphere == HemisphereSampling::cosine ? 1.0f : 2.0f);
                for (const Rgb& radiance : share(Block(paths, path), hemisphere))
                    expect_near(radiance, path.own, std::to_string(exponent).c_str());
            }
}

/// The one at the vertex has no weight that float holds, and another has one: it has to stay whole.
TEST(PathSharing, AVertexTooNearForItsOwnPathIsNotTheOthers) {
    SharedPath near, other;
    near.second = {0, 0, 1e-20f};
    near.own = {0.3f, 0.2f, 0.7f};
    other.first = {1, 0, -1};
    other.tail = {};
    const std::vector<Rgb> radiance = share({near, other}, HemisphereSampling::cosine);
    expect_near(radiance[0], near.own);
    EXPECT_EQ(radiance[1], (Rgb{}));
}

/// More visibility rays than lanes: each block as if it were the only one.
TEST(PathSharing, BlocksOfAFullBatchAreThoseThatStandAlone) {
    const Blocker half([](const Ray& ray) { return ray.direction.x > 0; });
    Batch batch;
    std::vector<Rgb> alone;
    for (std::size_t b = 0; b < max_lanes / max_sharing; ++b) {
        Block block;
        for (std::size_t i = 0; i < max_sharing; ++i) {
            SharedPath path = three_paths()[(b + i) % 3];
            path.first.y += 0.01f * static_cast<float>(i);
            path.second.x += 0.003f * static_cast<float>(b);
            block.push_back(path);
        }
        batch.push_back(block);
        for (const Rgb& radiance : share(block, HemisphereSampling::cosine, half))
            alone.push_back(radiance);
    }
    const Outcome outcome = outcome_of({batch}, HemisphereSampling::cosine, half);
    EXPECT_EQ(outcome.rays, max_lanes * (max_sharing - 1));
    EXPECT_EQ(outcome.radiance, alone);
}

/// Of the batch before there is nothing left.
TEST(PathSharing, ANewBatchStartsEmpty) {
    const Block before = three_paths();
    Block block = before;
    block[1].met_nothing = true;
    const Batch other{{before[0]}, block};
    const Outcome once = outcome_of({other}, HemisphereSampling::cosine);
    const Outcome again = outcome_of({{before, before}, other}, HemisphereSampling::cosine);
    EXPECT_EQ(once.radiance[2], (Rgb{}));
    EXPECT_EQ(again.radiance, once.radiance);
    EXPECT_EQ(again.rays, once.rays);
}

} // namespace
} // namespace plumb::test
