/// \file  The generated shapes of scene files, in Mitsuba's conventions, as triangle meshes.
#include "renderer/scene/shapes.h"

#include "accel/math/frame.h"

#include <cmath>

namespace plumb {
namespace {

constexpr double two_pi = 6.28318530717958647692;

/// Angle of the corner or edge i of n, exactly 0 again at i = n.
double angle_of(std::uint32_t i, std::uint32_t n) {
    return two_pi * static_cast<double>(i % n) / static_cast<double>(n);
}

float fraction(std::uint32_t i, std::uint32_t n) {
    return static_cast<float>(static_cast<double>(i) / static_cast<double>(n));
}

/// To world space with the front on the same side of the shape, mirrored or not.
Mesh placed(Mesh mesh, const Transform& to_world) {
    apply_transform(mesh, to_world);
    if (to_world.determinant() < 0 && mesh.normals.empty()) // apply_transform left it to the mirror
        turn_over(mesh);
    return mesh;
}

/// A face of the cube. In Mitsuba u runs along `u`, v along u x normal.
struct CubeFace {
    Vec3 normal, u;
};
constexpr CubeFace cube_faces[] = {{{0, -1, 0}, {0, 0, 1}}, {{0, 1, 0}, {-1, 0, 0}},
                                   {{1, 0, 0}, {0, 1, 0}},  {{0, 0, 1}, {0, 1, 0}},
                                   {{-1, 0, 0}, {0, 1, 0}}, {{0, 0, -1}, {0, -1, 0}}};

} // namespace

Mesh make_rectangle(const Transform& to_world) {
    Mesh mesh;
    mesh.name = "rectangle";
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {2, 3, 0}};
    mesh.is_rectangle = true;
    return placed(std::move(mesh), to_world);
}

Mesh make_cube(const Transform& to_world) {
    Mesh mesh;
    mesh.name = "cube";
    for (const CubeFace& face : cube_faces) {
        const Vec3 v = cross(face.u, face.normal);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec2 uv : {Vec2{0, 1}, Vec2{1, 1}, Vec2{1, 0}, Vec2{0, 0}}) {
            mesh.positions.push_back(face.normal + (2 * uv.x - 1) * face.u + (2 * uv.y - 1) * v);
            mesh.uvs.push_back(uv);
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first + 3, first, first + 2});
    }
    return placed(std::move(mesh), to_world);
}

Mesh make_disk(const Transform& to_world) {
    constexpr std::uint32_t n = tessellation_segments;
    const double step = two_pi / n;
    const double radius = std::sqrt(step / std::sin(step));
    Mesh mesh;
    mesh.name = "disk";
    for (std::uint32_t i = 0; i <= n; ++i) { // the seam has two corners: v is 0 and 1
        const double phi = angle_of(i, n);
        mesh.positions.push_back({static_cast<float>(radius * std::cos(phi)),
                                  static_cast<float>(radius * std::sin(phi)), 0});
        mesh.uvs.push_back({1, fraction(i, n)});
    }
    for (std::uint32_t i = 0; i < n; ++i) { // and each triangle its own centre, for its own v
        const auto center = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back({0, 0, 0});
        mesh.uvs.push_back({0, fraction(2 * i + 1, 2 * n)});
        mesh.triangles.push_back({center, i, i + 1});
    }
    return placed(std::move(mesh), to_world);
}

Mesh make_cylinder(Vec3 p0, Vec3 p1, float radius, const Transform& to_world) {
    constexpr std::uint32_t n = tessellation_segments;
    const double half_step = two_pi / 2 / n;
    const auto edge_radius =
        static_cast<float>(static_cast<double>(radius) * half_step / std::sin(half_step));
    const Frame frame(safe_normalize(p1 - p0));
    Mesh mesh;
    mesh.name = "cylinder";
    for (std::uint32_t i = 0; i <= n; ++i) { // the seam has two edges: u is 0 and 1
        const double phi = angle_of(i, n);
        const Vec3 outward = frame.to_world(
            {static_cast<float>(std::cos(phi)), static_cast<float>(std::sin(phi)), 0});
        for (const bool at_end : {false, true}) {
            mesh.positions.push_back((at_end ? p1 : p0) + edge_radius * outward);
            mesh.normals.push_back(outward);
            mesh.uvs.push_back({fraction(i, n), at_end ? 1.0f : 0.0f});
        }
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t low = 2 * i, high = low + 1, next_low = low + 2, next_high = low + 3;
        mesh.triangles.push_back({low, next_low, next_high});
        mesh.triangles.push_back({next_high, high, low});
    }
    return placed(std::move(mesh), to_world);
}

} // namespace plumb
