/// \file  Pixels that get no light beside pixels that do: sharing must not bring them any.
///
/// Paths have three segments, and the lamp shows the first vertices its back: what there is comes
/// from second vertices that the lamp lights. A pixel without has exactly nothing.

#include "tests/support/render_scene.h"
#include "tests/support/scene_text.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace plumb::test {
namespace {

std::string obj(std::string_view file, std::string_view material) {
    return shape("obj", "",
                 R"(<string name="filename" value=")" + std::string(file) + R"("/>)" +
                     std::string(material));
}

/// Two cards before the camera, and a lit wall beside them that only the lower one faces. The upper
/// one is turned away from it, but its shading normal is not.
struct Cards {
    std::string xml = scene_text(
        camera_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 9.15),
        obj("upper.obj", twosided({0.8, 0.8, 0.8})) +
            rectangle({0, -0.52, 0}, {0.48, 0, -0.36}, {0, 0.5, 0}, diffuse({0.8, 0.8, 0.8})) +
            rectangle({2, 0, -0.5}, {0, 0, 1.5}, {0, 2, 0}, diffuse({0.8, 0.8, 0.8})) +
            rectangle({1.2, 2.6, 0}, {0.045, 0.3, 0}, {0, 0, 0.3}, black_emitter({9, 9, 9})));
    SceneFileTexts files{{"upper.obj", R"(v -0.48 0.02 -0.36
v 0.48 0.02 0.36
v 0.48 0.52 0.36
v -0.48 0.52 -0.36
vn 0.6 0 0.8
f 1//1 2//1 3//1 4//1
)"}};
};

/// Two cards left and right of a lit floor, whose shading normal points to the left, away from the
/// lamp: so it does not reflect there. From the right that normal lies behind the floor, and the
/// geometric one counts. The camera sees the back of the floor.
struct Floor {
    std::string xml = scene_text(
        camera_at({0, 6, -1}, {0, 0, 1.3}, {0, 0, 1}, 33),
        obj("floor.obj", diffuse({0.8, 0.8, 0.8})) +
            rectangle({-1.2, 0, 1.2}, {-0.6, 0.8, 0}, {0, 0, 1.5}, diffuse({0.8, 0.8, 0.8})) +
            rectangle({1.2, 0, 1.2}, {-0.6, -0.8, 0}, {0, 0, 1.5}, diffuse({0.8, 0.8, 0.8})) +
            rectangle({1.8, -5, 2.5}, {0.2, 0, 0}, {0, -0.1, -0.2}, black_emitter({90, 90, 90})));
    SceneFileTexts files{{"floor.obj", R"(v -0.5 -0.5 0
v 0.5 -0.5 0
v 0.5 0.5 0
v -0.5 0.5 0
vn -0.95 0 0.3
f 1//1 2//1 3//1 4//1
)"}};
};

template <class SceneTexts> Image render_one_block(const SceneTexts& scene, int side, int reuse) {
    RenderSetup setup;
    setup.parameters = {{"side", std::to_string(side)}, {"spp", "2048"}, {"seed", "1"}};
    setup.adjust = [reuse](Scene& s) {
        s.path.max_depth = 3;
        s.path.hide_emitters = true;
        s.path.reuse = reuse;
    };
    return render_xml(scene.xml, setup, scene.files).image;
}

template <class SceneTexts> void expect_the_same_black_pixels(const SceneTexts& scene) {
    for (const int reuse : {2, 4}) {
        const Image plain = render_one_block(scene, reuse, 1);
        const auto black = std::count_if(plain.pixels.begin(), plain.pixels.end(), is_black);
        EXPECT_EQ(black, reuse * reuse / 2);
        const Image shared = render_one_block(scene, reuse, reuse);
        for (std::size_t p = 0; p < plain.pixels.size(); ++p)
            EXPECT_EQ(is_black(shared.pixels[p]), is_black(plain.pixels[p]))
                << "reuse " << reuse << " pixel " << p;
    }
}

TEST(PathSharingGuardsImage, NothingComesFromBelowTheGeometricNormalOfAFirstVertex) {
    expect_the_same_black_pixels(Cards{});
}

TEST(PathSharingGuardsImage, WhatASecondVertexReflectsElsewhereIsNotSharedWhereNormalsAreItsOwn) {
    expect_the_same_black_pixels(Floor{});
}

} // namespace
} // namespace plumb::test
