/// \file  What a scene file can ask of a mesh after it is read: transform, flip, drop normals.
#include "renderer/scene/mesh_edit.h"

#include "renderer/scene/double3.h"

#include <cmath>
#include <utility>

namespace plumb {
namespace {

/// Angle between two vectors, stable near 0 and pi; 0 if one of them is zero.
double angle(Double3 a, Double3 b) {
    const Double3 c = cross(a, b);
    return std::atan2(std::sqrt(dot(c, c)), dot(a, b));
}

void add(Double3& sum, Double3 direction, double weight) {
    sum.x += direction.x * weight;
    sum.y += direction.y * weight;
    sum.z += direction.z * weight;
}

/// The unit vector, or (0,0,1) along zero.
Vec3 to_unit(Double3 v) {
    const double length = std::sqrt(dot(v, v));
    if (!(length > 0))
        return {0, 0, 1};
    return {static_cast<float>(v.x / length), static_cast<float>(v.y / length),
            static_cast<float>(v.z / length)};
}

/// At b, up to the rounding of the coordinates.
bool has_right_angle(Vec3 a, Vec3 b, Vec3 c) {
    const Double3 ba = edge(b, a), bc = edge(b, c);
    const double lengths[2] = {std::sqrt(dot(ba, ba)), std::sqrt(dot(bc, bc))};
    const double largest = static_cast<double>(
        max(max_component(abs(a)), max(max_component(abs(b)), max_component(abs(c)))));
    const double rounding = 4 * 0x1p-24 * largest * (lengths[0] + lengths[1]);
    return std::fabs(dot(ba, bc)) <= 1e-5 * lengths[0] * lengths[1] + rounding;
}

} // namespace

void turn_over(Mesh& mesh) {
    if (mesh.is_rectangle) {
        std::swap(mesh.positions[1], mesh.positions[3]);
        if (!mesh.normals.empty())
            std::swap(mesh.normals[1], mesh.normals[3]);
        if (!mesh.uvs.empty())
            std::swap(mesh.uvs[1], mesh.uvs[3]);
        return;
    }
    for (Triangle& t : mesh.triangles)
        std::swap(t.b, t.c);
}

void apply_transform(Mesh& mesh, const Transform& to_world) {
    for (Vec3& p : mesh.positions)
        p = to_world.point(p);
    for (Vec3& n : mesh.normals)
        n = to_world.normal(n);
    if (to_world.determinant() < 0 && !mesh.normals.empty())
        turn_over(mesh);
    if (mesh.is_rectangle)
        mesh.is_rectangle =
            has_right_angle(mesh.positions[0], mesh.positions[1], mesh.positions[2]);
}

void flip_normals(Mesh& mesh) {
    turn_over(mesh);
    for (Vec3& n : mesh.normals)
        n = -n;
}

void drop_normals(Mesh& mesh) {
    mesh.normals.clear();
    mesh.normals.shrink_to_fit();
}

void compute_normals(Mesh& mesh) {
    std::vector<Double3> sums(mesh.positions.size());
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.positions[t.a], b = mesh.positions[t.b], c = mesh.positions[t.c];
        const Double3 ab = edge(a, b), bc = edge(b, c), ca = edge(c, a);
        const Double3 normal = cross(ab, edge(a, c));
        const double length = std::sqrt(dot(normal, normal));
        if (!(length > 0))
            continue;
        const double pi_exact = 3.14159265358979323846;
        add(sums[t.a], normal, (pi_exact - angle(ca, ab)) / length);
        add(sums[t.b], normal, (pi_exact - angle(ab, bc)) / length);
        add(sums[t.c], normal, (pi_exact - angle(bc, ca)) / length);
    }
    mesh.normals.resize(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
        mesh.normals[i] = to_unit(sums[i]);
}

bool has_flat_normals(const Mesh& mesh) {
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.positions[t.a];
        const Vec3 face =
            to_unit(cross(edge(a, mesh.positions[t.b]), edge(a, mesh.positions[t.c])));
        for (const std::uint32_t i : {t.a, t.b, t.c})
            if (max_component(abs(mesh.normals[i] - face)) > 1e-6f)
                return false;
    }
    return true;
}

} // namespace plumb
