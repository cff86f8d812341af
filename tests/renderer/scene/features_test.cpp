/// \file  What a scene is found to contain, and which profile serves it.

#include "renderer/scene/features.h"
#include "renderer/scene/shapes.h"

#include <gtest/gtest.h>

#include <initializer_list>

namespace plumb::test {
namespace {

constexpr Rgb light{1, 2, 3};

void add(Scene& scene, Mesh mesh, Rgb emission = {}) {
    scene.meshes.push_back(std::move(mesh));
    Surface surface;
    surface.emission = emission;
    // Surfaces of meshes come before those of spheres.
    scene.surfaces.insert(
        scene.surfaces.begin() + static_cast<std::ptrdiff_t>(scene.meshes.size() - 1), surface);
}

void add(Scene& scene, const Sphere& sphere, Rgb emission = {}) {
    scene.spheres.push_back(sphere);
    scene.surfaces.emplace_back().emission = emission;
}

TEST(FeaturesOf, FindsNothingInAnEmptyScene) {
    EXPECT_EQ(features_of(Scene{}), Features{});
    EXPECT_EQ(profile_name(features_of(Scene{})), "box");
}

TEST(FeaturesOf, ServesABoxWithOneRectangleLightByTheBoxProfile) {
    Scene scene;
    add(scene, make_cube({}));
    add(scene, make_rectangle({}), light);
    EXPECT_EQ(features_of(scene), Features{});
    EXPECT_EQ(profile_name(features_of(scene)), "box");
}

TEST(FeaturesOf, TellsEachFeatureAlone) {
    Scene sphere, smooth, two, triangles, point, sky, sphere_lights;
    add(sphere, Sphere{}, light);
    Mesh mesh = make_rectangle({});
    compute_normals(mesh);
    add(smooth, mesh);
    add(two, make_rectangle({}), light);
    add(two, make_rectangle({}), light);
    Mesh triangle = make_rectangle({});
    triangle.is_rectangle = false;
    triangle.triangles.pop_back();
    add(triangles, triangle, light);
    point.point_lights.push_back({});
    sky.environment = {0, 0, 0.5f};
    add(sphere_lights, make_cube({}));
    add(sphere_lights, Sphere{}, light);
    add(sphere_lights, Sphere{}, light);
    using F = Features;
    EXPECT_EQ(features_of(sphere), (F{.spheres = true}));
    EXPECT_EQ(features_of(smooth), (F{.smooth_normals = true}));
    EXPECT_EQ(features_of(two), (F{.many_lights = true}));
    EXPECT_EQ(features_of(triangles), (F{.triangle_lights = true}));
    EXPECT_EQ(features_of(point), (F{.point_lights = true}));
    EXPECT_EQ(features_of(sky), (F{.environment = true}));
    EXPECT_EQ(features_of(sphere_lights), (F{.spheres = true, .many_lights = true}));
    for (const Scene* s : {&sphere, &smooth, &two, &triangles, &point, &sky, &sphere_lights})
        EXPECT_EQ(profile_name(features_of(*s)), "full");
}

/// One light of each of two kinds is two lights.
TEST(FeaturesOf, CountsLightsOfAllKindsTogether) {
    Scene scene;
    add(scene, make_rectangle({}), light);
    EXPECT_FALSE(features_of(scene).many_lights);
    scene.environment = light;
    EXPECT_TRUE(features_of(scene).many_lights);
    scene.environment = {};
    scene.point_lights.push_back({});
    EXPECT_TRUE(features_of(scene).many_lights);
}

TEST(FeaturesOf, CountsEachTriangleOfAMeshLight) {
    Scene scene;
    add(scene, make_disk({}), light);
    EXPECT_TRUE(features_of(scene).many_lights);
    EXPECT_TRUE(features_of(scene).triangle_lights);
}

TEST(Features, CoverWhatTheyHaveAndNothingElse) {
    using F = Features;
    for (const F& one :
         {F{.spheres = true}, F{.smooth_normals = true}, F{.many_lights = true},
          F{.triangle_lights = true}, F{.point_lights = true}, F{.environment = true}}) {
        EXPECT_TRUE(full_profile.covers(one));
        EXPECT_FALSE(box_profile.covers(one));
        EXPECT_TRUE(one.covers(box_profile));
        EXPECT_TRUE(one.covers(one));
        EXPECT_FALSE(one.covers(full_profile));
    }
}

} // namespace
} // namespace plumb::test
