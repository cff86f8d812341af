/// \file  Paths without an end of their own: bounded work, no deep stack, no light lost.

#include "tests/support/oracle_parts.h"

#include <gtest/gtest.h>

namespace plumb::test {
namespace {

constexpr int segments = 1000000; // recursion ends at 65,501 on a stack of 8 MB

/// Albedo 1 everywhere and emission 1: a path of D segments carries radiance D exactly, as long as
/// no ray escapes.
std::string white_furnace(const std::string& walls) {
    return scene_text(camera_at({0.2, -0.1, 0.3}, {-0.4, 0.5, -1}, up_z, 40), walls);
}

const std::string white_inside =
    diffuse({1, 1, 1}) + area_emitter({1, 1, 1}) + R"(<boolean name="flip_normals" value="true"/>)";

Rgb radiance_of(const std::string& walls, Estimator estimator) {
    RenderSetup setup;
    setup.parameters = {{"side", "1"}};
    setup.adjust = [estimator](Scene& scene) {
        scene.path.max_depth = segments;
        scene.path.roulette = RouletteKind::none;
        scene.path.estimator = estimator;
    };
    const Rendered result = render_xml(white_furnace(walls), setup);
    EXPECT_EQ(result.stats.rays.bounce, std::uint64_t{segments} - 1);
    return result.image.pixels.at(0);
}

TEST(LongPathsImage, AMillionBouncesInASphereEndAndLoseNothing) {
    EXPECT_EQ(radiance_of(sphere({0, 0, 0}, 1.3, white_inside), Estimator::bsdf).g, segments);
}

TEST(LongPathsImage, AMillionBouncesInABoxEndAndLoseNothing) {
    const std::string box = shape("cube", R"(<scale x="1.1" y="0.8" z="1.4"/>)", white_inside);
    EXPECT_EQ(radiance_of(box, Estimator::bsdf).g, segments);
}

/// The same number with noise: most of it is sampled at the lights.
TEST(LongPathsImage, AMillionBouncesWithLightSamplingEnd) {
    const std::string box = shape("cube", R"(<scale x="1.1" y="0.8" z="1.4"/>)", white_inside);
    EXPECT_NEAR(radiance_of(box, Estimator::mis).g, segments, 0.01 * segments);
}

} // namespace
} // namespace plumb::test
