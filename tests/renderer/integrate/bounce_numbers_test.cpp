/// \file  Which numbers of the sampler a bounce gets.

#include "renderer/integrate/path_steps.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace plumb::test {
namespace {

/// The numbers of all samples of one pixel at one bounce, with roulette from the first on.
std::vector<BounceNumbers> numbers_of(std::uint32_t pixel, int depth, std::uint32_t spp) {
    const SceneView scene;
    PathSettings settings;
    settings.rr_depth = 1;
    const PathSteps<box_profile> steps(scene, settings);
    std::vector<BounceNumbers> all;
    for (std::uint32_t i = 0; i < spp; ++i)
        all.push_back(steps.numbers(Sampler(SamplerKind::sobol, 5, pixel, i), depth));
    return all;
}

std::size_t cell(float x, std::size_t cells) {
    return static_cast<std::size_t>(x * static_cast<float>(cells));
}

/// 256 points in 16 boxes of four dimensions: 16 each. Directions that know nothing of each other
/// leave 4 more or less.
TEST(BounceNumbers, StratifyTheDirectionsOfTwoBouncesTogether) {
    for (std::uint32_t pixel = 0; pixel < 20; ++pixel)
        for (const int depth : {1, 3, 7}) {
            const auto first = numbers_of(pixel, depth, 256);
            const auto second = numbers_of(pixel, depth + 1, 256);
            std::size_t count[16] = {};
            for (std::size_t i = 0; i < first.size(); ++i)
                ++count[cell(first[i].direction.x, 2) + 2 * cell(first[i].direction.y, 2) +
                        4 * cell(second[i].direction.x, 2) + 8 * cell(second[i].direction.y, 2)];
            for (const std::size_t n : count)
                EXPECT_EQ(n, 16u) << pixel << ' ' << depth;
        }
}

/// One of 256 light points in each of 16 x 16 boxes, and of 4 x 64.
TEST(BounceNumbers, PutOneLightPointIntoEachElementaryBox) {
    for (std::uint32_t pixel = 0; pixel < 20; ++pixel)
        for (int depth = 1; depth < 8; ++depth)
            for (const std::size_t columns : {4u, 16u, 64u}) {
                std::set<std::size_t> taken;
                for (const BounceNumbers& n : numbers_of(pixel, depth, 256))
                    taken.insert(columns * cell(n.light_point.y, 256 / columns) +
                                 cell(n.light_point.x, columns));
                EXPECT_EQ(taken.size(), 256u) << pixel << ' ' << depth;
            }
}

/// The light and roulette are stratified, each by itself.
TEST(BounceNumbers, PutOneChoiceIntoEachInterval) {
    for (int depth = 1; depth < 8; ++depth) {
        std::set<std::size_t> lights, roulettes;
        for (const BounceNumbers& n : numbers_of(3, depth, 256)) {
            lights.insert(cell(n.light, 256));
            roulettes.insert(cell(n.roulette, 256));
        }
        EXPECT_EQ(lights.size(), 256u) << depth;
        EXPECT_EQ(roulettes.size(), 256u) << depth;
    }
}

/// No number is used twice.
TEST(BounceNumbers, AreDifferentAtEveryBounce) {
    std::set<float> seen;
    std::size_t drawn = 0;
    for (int depth = 1; depth <= 12; ++depth)
        for (const BounceNumbers& n : numbers_of(9, depth, 16)) {
            seen.insert({n.light_point.x, n.light_point.y, n.light, n.roulette, n.direction.x,
                         n.direction.y});
            drawn += 6;
        }
    EXPECT_EQ(seen.size(), drawn);
}

} // namespace
} // namespace plumb::test
