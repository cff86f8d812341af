/// \file  Generated shapes and mesh edits: areas from formulas, fronts from geometry.
#include "renderer/scene/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumb {
namespace {

constexpr double pi_exact = 3.14159265358979323846;

Vec3 geometric_normal(const Mesh& mesh, const Triangle& t) {
    const Vec3 a = mesh.positions[t.a];
    return cross(mesh.positions[t.b] - a, mesh.positions[t.c] - a);
}

double area(const Mesh& mesh) {
    double sum = 0;
    for (const Triangle& t : mesh.triangles)
        sum += 0.5 * static_cast<double>(length(geometric_normal(mesh, t)));
    return sum;
}

Vec3 centroid(const Mesh& mesh, const Triangle& t) {
    return (mesh.positions[t.a] + mesh.positions[t.b] + mesh.positions[t.c]) / 3;
}

/// Triangles whose front looks away from the direction `out` gives for their centroid.
template <class Outward> int inward_triangles(const Mesh& mesh, Outward out) {
    int count = 0;
    for (const Triangle& t : mesh.triangles)
        count += dot(geometric_normal(mesh, t), out(centroid(mesh, t))) > 0 ? 0 : 1;
    return count;
}

const Transform mirror = Transform::scale(-1, 1, 1);
const Transform placement =
    Transform::translate(1, -2, 3) * Transform::rotate(1, 2, 3, 70) * Transform::scale(2, 2, 2);

TEST(Shapes, RectangleFacesPlusZWithUvFromPosition) {
    const Mesh mesh = make_rectangle({});
    EXPECT_TRUE(mesh.is_rectangle);
    EXPECT_DOUBLE_EQ(area(mesh), 4.0);
    ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(mesh.uvs[i].x, (mesh.positions[i].x + 1) / 2);
        EXPECT_EQ(mesh.uvs[i].y, (mesh.positions[i].y + 1) / 2);
    }
    EXPECT_EQ(inward_triangles(mesh, [](Vec3) { return Vec3{0, 0, 1}; }), 0);
}

TEST(Shapes, MirroredRectangleKeepsItsFrontAndItsForm) {
    const Mesh mesh = make_rectangle(mirror);
    EXPECT_TRUE(mesh.is_rectangle);
    EXPECT_EQ(inward_triangles(mesh, [](Vec3) { return Vec3{0, 0, 1}; }), 0);
    // The light sampler relies on these: a right angle at b of triangle 0, and the fixed indices.
    const Triangle t = mesh.triangles[0];
    EXPECT_EQ(t.a, 0u);
    EXPECT_EQ(t.b, 1u);
    EXPECT_EQ(t.c, 2u);
    EXPECT_EQ(dot(mesh.positions[0] - mesh.positions[1], mesh.positions[2] - mesh.positions[1]), 0);
    for (std::size_t i = 0; i < 4; ++i) // the uvs move with their vertices
        EXPECT_EQ(mesh.uvs[i].x, (-mesh.positions[i].x + 1) / 2);
}

TEST(Shapes, ShearedRectangleIsNoRectangle) {
    Transform shear;
    shear.m[0][1] = 1e-3;
    EXPECT_FALSE(make_rectangle(shear).is_rectangle);
    EXPECT_TRUE(make_rectangle(placement).is_rectangle);
    EXPECT_TRUE(make_rectangle(Transform::translate(1000, 2000, -500) *
                               Transform::rotate(3, 2, 1, 33) * Transform::scale(0.5, 3, 1))
                    .is_rectangle);
}

TEST(Shapes, CubeHasTwelveOutwardTrianglesAndAFullUvSquareOnEachFace) {
    const Mesh mesh = make_cube({});
    EXPECT_EQ(mesh.positions.size(), 24u);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_DOUBLE_EQ(area(mesh), 24.0);
    EXPECT_EQ(inward_triangles(mesh, [](Vec3 c) { return c; }), 0);
    for (std::size_t i = 0; i < 24; ++i)
        EXPECT_EQ(max_component(abs(mesh.positions[i])), 1) << i;
    for (const Triangle& t : mesh.triangles) { // half the uv square each
        const Vec2 a = mesh.uvs[t.a], b = mesh.uvs[t.b], c = mesh.uvs[t.c];
        EXPECT_EQ(std::fabs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)), 1);
    }
    EXPECT_EQ(inward_triangles(make_cube(mirror), [](Vec3 c) { return c; }), 0);
}

TEST(Shapes, DiskHasTheAreaOfACircle) {
    const Mesh mesh = make_disk({});
    EXPECT_EQ(mesh.triangles.size(), 256u);
    EXPECT_NEAR(area(mesh), pi_exact, 1e-6);
    EXPECT_EQ(inward_triangles(mesh, [](Vec3) { return Vec3{0, 0, 1}; }), 0);
    EXPECT_EQ(inward_triangles(make_disk(mirror), [](Vec3) { return Vec3{0, 0, 1}; }), 0);
    for (const Vec3 p : mesh.positions) {
        EXPECT_EQ(p.z, 0);
        EXPECT_LT(length(p), 1 + 5.1e-5f);
    }
    EXPECT_NEAR(area(make_disk(placement)), 4 * pi_exact, 5e-6);
}

TEST(Shapes, CylinderHasTheAreaOfItsSideAndOutwardNormals) {
    const Vec3 p0{1, 2, 3}, p1{2, 0, 5}; // length 3
    const float radius = 0.25f;
    for (const Transform& to_world : {Transform{}, mirror}) {
        const Mesh mesh = make_cylinder(p0, p1, radius, to_world);
        EXPECT_EQ(mesh.triangles.size(), 512u);
        EXPECT_NEAR(area(mesh), 2 * pi_exact * 0.25 * 3, 5e-6);
        const Vec3 start = to_world.point(p0), axis = (to_world.point(p1) - start) / 3;
        const auto outward = [&](Vec3 p) { return p - start - axis * dot(p - start, axis); };
        EXPECT_EQ(inward_triangles(mesh, outward), 0);
        ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            EXPECT_NEAR(length(outward(mesh.positions[i])), radius, 3e-5 * 0.25 + 1e-6);
            EXPECT_NEAR(dot(mesh.normals[i], outward(mesh.positions[i])), radius, 1e-5);
            EXPECT_NEAR(length(mesh.normals[i]), 1, 1e-6);
        }
    }
}

TEST(Shapes, FlippedShapesFaceInwards) {
    Mesh cube = make_cube({});
    flip_normals(cube);
    EXPECT_EQ(inward_triangles(cube, [](Vec3 c) { return c; }), 12);
    Mesh cylinder = make_cylinder({0, 0, 0}, {0, 0, 1}, 1, {});
    flip_normals(cylinder);
    EXPECT_EQ(inward_triangles(cylinder, [](Vec3 c) { return Vec3{c.x, c.y, 0}; }), 512);
    EXPECT_LT(dot(cylinder.normals[0], cylinder.positions[0]), 0);
    Mesh rectangle = make_rectangle({});
    flip_normals(rectangle);
    EXPECT_TRUE(rectangle.is_rectangle);
    EXPECT_EQ(inward_triangles(rectangle, [](Vec3) { return Vec3{0, 0, -1}; }), 0);
}

TEST(MeshEdit, MirrorMovesTheFrontOnlyOfMeshesWithoutNormals) {
    Mesh flat;
    flat.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    flat.triangles = {{0, 1, 2}};
    Mesh smooth = flat;
    smooth.normals.assign(3, {0, 0, 1});
    apply_transform(flat, mirror);
    apply_transform(smooth, mirror);
    EXPECT_LT(geometric_normal(flat, flat.triangles[0]).z, 0);
    EXPECT_GT(geometric_normal(smooth, smooth.triangles[0]).z, 0);
    EXPECT_EQ(smooth.normals[0].z, 1);
}

TEST(MeshEdit, NormalsTransformByTheInverseTranspose) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, -1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 1, 2}};
    const float h = std::sqrt(0.5f);
    mesh.normals.assign(3, {-h, -h, 0});
    apply_transform(mesh, Transform::scale(1, 3, 1));
    for (const Vec3 n : mesh.normals) { // still at right angles to the surface
        EXPECT_NEAR(length(n), 1, 1e-6);
        EXPECT_NEAR(dot(n, mesh.positions[1]), 0, 1e-6);
    }
    EXPECT_GT(dot(geometric_normal(mesh, mesh.triangles[0]), mesh.normals[0]), 0);
}

TEST(MeshEdit, OnlyPlaneMeshesHaveFlatComputedNormals) {
    Mesh square;
    square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    compute_normals(square);
    EXPECT_TRUE(has_flat_normals(square));

    Mesh folded = square;
    folded.positions[3].z = 0.1f;
    compute_normals(folded);
    EXPECT_FALSE(has_flat_normals(folded));
}

TEST(MeshEdit, ComputedNormalsWeightTrianglesByAngle) {
    // A cube corner: one face as two triangles, the others whole. Angle weights see three equal
    // faces; area or uniform weights do not.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {9, 9, 9}};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {0, 4, 3}};
    compute_normals(mesh);
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(mesh.normals[0][axis], -std::sqrt(1.0f / 3), 1e-6);
    EXPECT_EQ(mesh.normals[5], (Vec3{0, 0, 1})); // of no triangle
    drop_normals(mesh);
    EXPECT_TRUE(mesh.normals.empty());
}

} // namespace
} // namespace plumb
