/// \file  Meshes of files; apart from catalogue.cpp, which needs no reader.
#include "renderer/io/read_obj.h"
#include "renderer/io/read_ply.h"
#include "renderer/scene/error.h"
#include "tools/bench_src/catalogue.h"

#include <algorithm>

namespace plumb::bench {
namespace {

/// A camera on the diagonal of the box that sees all of it, a light beside it.
Viewpoint view_of(const Bounds& box) {
    const Vec3 center = box.center();
    const float radius = 0.5f * length(box.extent());
    Viewpoint view;
    view.eye = center + normalize({0.6f, 0.4f, 0.9f}) * (2.2f * radius);
    view.target = center;
    view.fov_x_deg = 45;
    view.light = center + normalize({0.8f, 1, 0.3f}) * (2 * radius);
    view.light_radius = 0.1f * radius;
    return view;
}

} // namespace

BenchMesh load_mesh(const std::filesystem::path& file, std::vector<std::string>& warnings) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    if (extension != ".obj" && extension != ".ply")
        throw SceneError(ErrorKind::mesh, {file.string()}, "a mesh is an .obj or a .ply file");
    plumb::Mesh read = extension == ".obj" ? read_obj(file, warnings) : read_ply(file, warnings);
    if (read.triangles.empty())
        throw SceneError(ErrorKind::mesh, {file.string()}, "no triangles");
    BenchMesh mesh;
    mesh.name = file.stem().string();
    mesh.positions = std::move(read.positions);
    mesh.triangles = std::move(read.triangles);
    mesh.view = view_of(bounds_of(mesh));
    return mesh;
}

} // namespace plumb::bench
