/// \file  The lights that a scene's surfaces become, and how they are chosen.

#include "renderer/scene/scene_tables.h"
#include "renderer/scene/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumb::test {
namespace {

constexpr double pi_double = 3.14159265358979323846;

/// Meshes first, then spheres, each with its emission.
struct Builder {
    Scene scene;

    Builder& mesh(Mesh mesh, Rgb emission = {}) {
        scene.meshes.push_back(std::move(mesh));
        scene.surfaces.emplace_back().emission = emission;
        return *this;
    }
    Builder& sphere(Vec3 center, float radius, Rgb emission = {}, bool flip = false) {
        scene.spheres.push_back({center, radius});
        Surface& surface = scene.surfaces.emplace_back();
        surface.emission = emission;
        surface.flip_normal = flip;
        return *this;
    }
};

Transform scaled(double x, double y) { return Transform::scale(x, y, 1); }

void expect_near(Vec3 found, Vec3 wanted, float tolerance = 1e-6f) {
    EXPECT_NEAR(found.x, wanted.x, tolerance);
    EXPECT_NEAR(found.y, wanted.y, tolerance);
    EXPECT_NEAR(found.z, wanted.z, tolerance);
}

TEST(SceneTables, AreEmptyForAnEmptyScene) {
    const Scene scene;
    const SceneTables tables(scene);
    EXPECT_TRUE(tables.view().lights.empty());
    EXPECT_TRUE(tables.view().light_cdf.empty());
    EXPECT_EQ(tables.view().environment, invalid_id);
    EXPECT_EQ(tables.geometry().primitive_count(), 0u);
}

TEST(SceneTables, MakeOneLightOfARectangle) {
    Builder b;
    b.mesh(make_cube({}))
        .mesh(make_rectangle(Transform::translate(1, 2, 3) * Transform::rotate(1, 0, 0, 90) *
                             scaled(1.5, 0.25)),
              {3, 2, 1});
    const SceneTables tables(b.scene);
    ASSERT_EQ(tables.view().lights.size(), 1u);
    const Light& light = tables.view().lights[0];
    EXPECT_EQ(light.kind, LightKind::rectangle);
    EXPECT_EQ(light.emission, (Rgb{3, 2, 1}));
    EXPECT_FLOAT_EQ(light.area, 3 * 0.5f);
    expect_near(light.normal, {0, -1, 0}); // +z turned by 90 degrees about x
    EXPECT_NEAR(dot(light.edge1, light.edge2), 0, 1e-6);
    EXPECT_FLOAT_EQ(length(cross(light.edge1, light.edge2)), light.area);
    expect_near(normalize(cross(light.edge1, light.edge2)), light.normal);
    expect_near(light.origin + light.edge1 * 0.5f + light.edge2 * 0.5f, {1, 2, 3});
    EXPECT_EQ(light.probability, 1.0f);
    EXPECT_EQ(tables.view().surface_lights[0].first, invalid_id);
    EXPECT_EQ(tables.view().surface_lights[1].first, 0u);
    EXPECT_FALSE(tables.view().surface_lights[1].per_primitive);
}

/// Turned over or mirrored: the light's normal is the front of its triangles.
TEST(SceneTables, FollowTheFrontOfARectangle) {
    Mesh turned = make_rectangle({});
    flip_normals(turned);
    const Mesh mirrored = make_rectangle(Transform::scale(-2, 1, 1));
    for (const Mesh& mesh : {turned, mirrored}) {
        Builder b;
        b.mesh(mesh, {1, 1, 1});
        const SceneTables tables(b.scene);
        const Light& light = tables.view().lights[0];
        const TriangleVertices t = tables.geometry().vertices(0, 0);
        expect_near(light.normal, normalize(cross(t.b - t.a, t.c - t.a)));
        expect_near(normalize(cross(light.edge1, light.edge2)), light.normal);
        for (const Vec3 corner : mesh.positions) { // the parallelogram has the mesh's corners
            bool found = false;
            for (const float s : {0.0f, 1.0f})
                for (const float r : {0.0f, 1.0f})
                    found |=
                        length(light.origin + light.edge1 * s + light.edge2 * r - corner) < 1e-6f;
            EXPECT_TRUE(found);
        }
    }
}

TEST(SceneTables, MakeALightOfEachTriangleInOrder) {
    Builder b;
    b.mesh(make_rectangle(scaled(2, 2)), {1, 1, 1}).mesh(make_cube({}), {0, 1, 0});
    const SceneTables tables(b.scene);
    const SceneView& view = tables.view();
    ASSERT_EQ(view.lights.size(), 1u + 12u);
    EXPECT_EQ(view.surface_lights[1].first, 1u);
    EXPECT_TRUE(view.surface_lights[1].per_primitive);
    for (std::uint32_t p = 0; p < 12; ++p) {
        const Light& light = view.lights[1 + p];
        const TriangleVertices t = view.geometry.vertices(1, p);
        EXPECT_EQ(light.kind, LightKind::triangle);
        EXPECT_EQ(light.origin, t.a);
        EXPECT_EQ(light.edge1, t.b - t.a);
        EXPECT_EQ(light.edge2, t.c - t.a);
        EXPECT_FLOAT_EQ(light.area, 2);
        EXPECT_GT(dot(light.normal, light.origin), 0); // the cube shines outwards
    }
}

TEST(SceneTables, MakeALightOfASphere) {
    Builder b;
    b.mesh(make_cube({})).sphere({1, 2, 3}, 0.5f).sphere({4, 5, 6}, 1.5f, {2, 2, 2}, true);
    const SceneTables tables(b.scene);
    const SceneView& view = tables.view();
    ASSERT_EQ(view.lights.size(), 1u);
    EXPECT_EQ(view.lights[0].kind, LightKind::sphere);
    EXPECT_EQ(view.lights[0].origin, (Vec3{4, 5, 6}));
    EXPECT_EQ(view.lights[0].radius, 1.5f);
    EXPECT_FLOAT_EQ(view.lights[0].area, static_cast<float>(9 * pi_double));
    EXPECT_TRUE(view.lights[0].inside_out);
    EXPECT_EQ(view.surface_lights[2].first, 0u);
    EXPECT_EQ(view.surface_of({1, 0, 0, 1, 1, invalid_id}), 2u); // second sphere, third surface
    EXPECT_EQ(view.surface_of({1, 0, 0, 0, 7, invalid_id}), 0u);
}

/// Flux: pi L A of surfaces, 4 pi I of points, and what a sky sends into a sphere around the scene.
TEST(SceneTables, ChooseLightsByPower) {
    Builder b;
    b.mesh(make_rectangle(scaled(2, 3)), {5, 5, 5}) // A = 24
        .sphere({10, 0, 0}, 0.5f, {7, 7, 7});       // A = pi
    b.scene.point_lights.push_back({{0, 0, 5}, {11, 11, 11}});
    b.scene.environment = {0.25f, 0.25f, 0.25f};
    const SceneTables tables(b.scene);
    const SceneView& view = tables.view();
    ASSERT_EQ(view.lights.size(), 4u);
    // Bounds: x from -2 to 10.5, y from -3 to 3, z from -0.5 to 0.5.
    const double radius = 0.5 * std::sqrt(12.5 * 12.5 + 6.0 * 6.0 + 1.0 * 1.0);
    const double power[] = {pi_double * 24 * 5, pi_double * pi_double * 7, 4 * pi_double * 11,
                            0.25 * 4 * pi_double * pi_double * radius * radius};
    double total = 0;
    for (const double p : power)
        total += p;
    EXPECT_EQ(view.environment, 3u);
    EXPECT_EQ(view.light_cdf[0], 0.0f);
    EXPECT_EQ(view.light_cdf[4], 1.0f);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(static_cast<double>(view.lights[i].probability), power[i] / total, 1e-6) << i;
        EXPECT_EQ(view.lights[i].probability, view.light_cdf[i + 1] - view.light_cdf[i]);
    }
    EXPECT_EQ(view.lights[2].emission, (Rgb{11, 11, 11}));
    EXPECT_EQ(view.lights[2].origin, (Vec3{0, 0, 5}));
}

/// Degenerate triangles of a mesh light are never chosen; a light of nothing else is none.
TEST(SceneTables, NeverChooseLightsWithoutArea) {
    Mesh mesh = make_cube({});
    mesh.triangles[3] = {5, 5, 6};
    Builder b;
    b.mesh(mesh, {1, 1, 1});
    const SceneTables tables(b.scene);
    EXPECT_EQ(tables.view().lights[3].probability, 0.0f);
    EXPECT_EQ(tables.view().lights.size(), 12u);

    for (Triangle& t : mesh.triangles)
        t = {1, 1, 2};
    Builder none;
    none.mesh(mesh, {1, 1, 1});
    const SceneTables dark(none.scene);
    EXPECT_TRUE(dark.view().lights.empty());
    EXPECT_TRUE(dark.view().light_cdf.empty());
    EXPECT_EQ(dark.view().surface_lights[0].first, invalid_id);
}

TEST(SceneTables, ShowKernelsTheScenesOwnData) {
    Builder b;
    Mesh smooth = make_cube({});
    compute_normals(smooth);
    b.mesh(smooth).mesh(make_rectangle({}));
    b.scene.materials.resize(3);
    b.scene.film.width = 40;
    b.scene.film.height = 20;
    const SceneTables tables(b.scene);
    const SceneView& view = tables.view();
    EXPECT_EQ(view.normals[0].data(), b.scene.meshes[0].normals.data());
    EXPECT_TRUE(view.normals[1].empty());
    EXPECT_EQ(view.materials.data(), b.scene.materials.data());
    EXPECT_EQ(view.surfaces.size(), 2u);
    EXPECT_EQ(view.geometry.primitive_count(), 14u);
    EXPECT_FLOAT_EQ(std::fabs(view.camera.dx.x / view.camera.dy.y), 2); // the film's aspect
    EXPECT_EQ(b.scene.triangle_count(), 14u);
}

} // namespace
} // namespace plumb::test
