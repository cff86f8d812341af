/// \file  The last step of every mesh reader: what no renderer wants to meet later.
#include "renderer/io/finish_mesh.h"

#include "renderer/scene/double3.h"
#include "renderer/scene/mesh_edit.h"

#include <utility>

namespace plumb {
namespace {

/// Twice the area times the normal of the counter-clockwise side.
Double3 area_normal(const Mesh& mesh, const Triangle& t) {
    const Vec3 a = mesh.positions[t.a];
    return cross(edge(a, mesh.positions[t.b]), edge(a, mesh.positions[t.c]));
}

std::size_t drop_degenerate(Mesh& mesh) {
    return std::erase_if(mesh.triangles, [&](const Triangle& t) {
        const Double3 n = area_normal(mesh, t);
        return n.x == 0 && n.y == 0 && n.z == 0; // also where indices repeat
    });
}

/// Gives the number of zero normals that were replaced.
std::size_t normalize_normals(Mesh& mesh) {
    std::size_t zeros = 0;
    for (Vec3& n : mesh.normals) {
        n = safe_normalize(n);
        zeros += n == Vec3{} ? 1u : 0u;
    }
    if (zeros == 0)
        return 0;
    std::vector<Vec3> given = std::move(mesh.normals);
    compute_normals(mesh);
    for (std::size_t i = 0; i < given.size(); ++i)
        if (given[i] != Vec3{})
            mesh.normals[i] = given[i];
    return zeros;
}

std::size_t face_the_normals(Mesh& mesh) {
    if (mesh.normals.empty())
        return 0;
    std::size_t turned = 0;
    for (Triangle& t : mesh.triangles) {
        const Vec3 n = mesh.normals[t.a] + mesh.normals[t.b] + mesh.normals[t.c];
        if (dot(area_normal(mesh, t), edge({}, n)) >= 0)
            continue;
        std::swap(t.b, t.c);
        ++turned;
    }
    return turned;
}

} // namespace

void finish_mesh(Mesh& mesh, const std::string& file, std::size_t degenerate,
                 std::vector<std::string>& warnings) {
    const auto warn = [&](std::size_t count, const std::string& what) {
        if (count > 0)
            warnings.push_back(file + ": warning: " + std::to_string(count) + what);
    };
    const std::size_t all = degenerate + mesh.triangles.size();
    degenerate += drop_degenerate(mesh);
    warn(degenerate, " of " + std::to_string(all) + " triangles have no area and are dropped");
    warn(normalize_normals(mesh),
         " vertex normals are zero and are replaced by the mean of their triangles' normals");
    warn(face_the_normals(mesh),
         " triangles are wound against their vertex normals and are turned over");
    if (mesh.triangles.empty())
        warnings.push_back(file + ": warning: the mesh has no triangles");
}

} // namespace plumb
