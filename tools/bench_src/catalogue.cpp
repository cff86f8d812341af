#include "tools/bench_src/catalogue.h"

#include "renderer/io/read_obj.h"
#include "renderer/io/read_ply.h"
#include "renderer/scene/error.h"
#include "tools/bench_src/generate.h"

#include <algorithm>
#include <array>

namespace plumb::bench {
namespace {

constexpr std::array<CatalogueEntry, 8> entries{{
    {"cornell", "box room, two blocks: 36", cornell, 1},
    {"teapot", "fine teapot in a coarse stadium: 49 k", teapot, 0.05},
    {"needles", "long thin triangles at random: 60 k", needles, 0.02},
    {"bunny-like", "smooth closed surface: 69 k", blob, 0.05},
    {"hall", "colonnade with arches and stairs: 0.37 M", hall, 0.02},
    {"hair", "curled strands, thin ribbons: 0.84 M", hair, 0.01},
    {"scan-like", "rough closed surface: 1.6 M", scan, 0.005},
    {"terrain", "planet with mountains: 5.2 M", terrain, 0.002},
}};

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

std::span<const CatalogueEntry> catalogue() { return entries; }

BenchMesh generate(const CatalogueEntry& entry, bool quick) {
    BenchMesh mesh = entry.generate(quick ? entry.quick_detail : 1);
    mesh.name = entry.name;
    if (quick) {
        mesh.coherent_rays = std::min<std::size_t>(mesh.coherent_rays, std::size_t{1} << 13u);
        mesh.incoherent_rays = std::min<std::size_t>(mesh.incoherent_rays, std::size_t{1} << 12u);
    }
    return mesh;
}

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
