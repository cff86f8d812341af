/// \file  Reading of shapes.
#include "renderer/io/load_shape.h"

#include "renderer/io/load_emitter.h"
#include "renderer/io/load_properties.h"
#include "renderer/io/read_obj.h"
#include "renderer/io/read_ply.h"
#include "renderer/scene/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>

namespace plumb {
namespace {

/// The factor of a transform that keeps spheres spheres; nothing for any other.
std::optional<double> uniform_scale(const Transform& t) {
    constexpr double tolerance = 1e-4; // files carry six digits
    const auto dot = [&](std::size_t a, std::size_t b) {
        return t.m[0][a] * t.m[0][b] + t.m[1][a] * t.m[1][b] + t.m[2][a] * t.m[2][b];
    };
    const double squared = (dot(0, 0) + dot(1, 1) + dot(2, 2)) / 3;
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = a; b < 3; ++b)
            if (std::fabs(dot(a, b) - (a == b ? squared : 0)) > 2 * tolerance * squared)
                return std::nullopt;
    return std::sqrt(squared);
}

std::string mesh_name(const XmlNode& shape, const XmlAttribute* file) {
    if (const XmlAttribute* id = shape.find("id"))
        return std::string(id->value);
    return std::string(file ? file->value : shape.require("type").value);
}

void check_range(const XmlNode& shape, const Mesh& mesh) {
    if (!std::all_of(mesh.positions.begin(), mesh.positions.end(), is_finite))
        shape.refuse(fmt::format("vertices of '{}' too far away (expected coordinates up to {})",
                                 mesh.name, max_coordinate));
}

} // namespace

void ShapeLoader::load(const XmlNode& shape) {
    const std::string_view plugin = context_.plugin(
        shape, {"obj", "ply", "sphere", "rectangle", "cube", "disk", "cylinder"}, "left out");
    if (plugin.empty())
        return;
    Properties p(context_, shape);
    Scene& scene = context_.scene;
    Surface surface = load_surface(p);
    const bool flip = p.boolean("flip_normals", false);
    if (plugin == "sphere") {
        surface.flip_normal = flip;
        scene.spheres.push_back(load_sphere(p));
        sphere_surfaces_.push_back(surface);
    } else {
        Mesh mesh = load_mesh(p, plugin);
        check_range(shape, mesh);
        if (flip)
            flip_normals(mesh);
        scene.meshes.push_back(std::move(mesh));
        mesh_surfaces_.push_back(surface);
    }
    p.changes_no_pixel({"silhouette_sampling_weight"});
    p.finish();
}

void ShapeLoader::finish() {
    std::vector<Surface>& all = context_.scene.surfaces;
    all = std::move(mesh_surfaces_);
    all.insert(all.end(), sphere_surfaces_.begin(), sphere_surfaces_.end());
}

Mesh ShapeLoader::load_mesh(Properties& p, std::string_view plugin) {
    if (plugin == "obj" || plugin == "ply")
        return load_mesh_file(p, plugin);
    const Transform to_world = p.transform("to_world");
    Mesh mesh;
    if (plugin == "cylinder") {
        const Vec3 p0 = p.point("p0", {0, 0, 0}), p1 = p.point("p1", {0, 0, 1});
        const double radius = p.positive("radius", 1);
        if (p0 == p1)
            p.node().refuse("cylinder with p0 = p1 (expected two points)");
        mesh = make_cylinder(p0, p1, static_cast<float>(radius), to_world);
    } else if (plugin == "disk") {
        mesh = make_disk(to_world);
    } else if (plugin == "cube") {
        mesh = make_cube(to_world);
    } else {
        mesh = make_rectangle(to_world);
    }
    mesh.name = mesh_name(p.node(), nullptr);
    if (p.boolean("face_normals", false))
        drop_normals(mesh);
    return mesh;
}

Mesh ShapeLoader::load_mesh_file(Properties& p, std::string_view plugin) {
    const XmlAttribute* name = p.string("filename");
    if (!name)
        p.node().refuse(fmt::format("missing property 'filename' of shape '{}'", plugin));
    const std::filesystem::path file = context_.file(p.node(), *name);
    std::vector<std::string>& warnings = context_.scene.warnings;
    Mesh mesh = plugin == "obj" ? read_obj(file, warnings) : read_ply(file, warnings);
    mesh.name = mesh_name(p.node(), name);
    const bool flat = p.boolean("face_normals", false);
    if (flat)
        drop_normals(mesh);
    // Files without normals are smooth, as Mitsuba has it.
    const bool smooth = !flat && mesh.normals.empty();
    apply_transform(mesh, p.transform("to_world"));
    if (smooth)
        compute_normals(mesh);
    if (smooth && has_flat_normals(mesh))
        drop_normals(mesh);
    p.not_supported({"max_smooth_angle", "shape_index", "shape_name"});
    // Texture coordinates and tangents: nothing reads them yet.
    p.changes_no_pixel({"flip_tex_coords", "flip_uvs", "srgb", "load_materials", "collapse"});
    return mesh;
}

Sphere ShapeLoader::load_sphere(Properties& p) {
    const Transform to_world = p.transform("to_world");
    const auto scale = uniform_scale(to_world);
    if (!scale)
        p.node().refuse("sphere with a non-uniform scale (expected rotation, translation, "
                        "reflection and uniform scale)");
    const double radius = p.positive("radius", 1) * *scale;
    const Sphere sphere{to_world.point(p.point("center", {0, 0, 0})), static_cast<float>(radius)};
    if (!is_finite(sphere.center) || !(sphere.radius > 0) || sphere.radius > max_coordinate)
        p.node().refuse(fmt::format("sphere out of range (got radius {}, expected one above 0 and "
                                    "coordinates up to {})",
                                    radius, max_coordinate));
    return sphere;
}

Surface ShapeLoader::load_surface(Properties& p) {
    const std::vector<const XmlNode*> bsdfs = p.objects("bsdf");
    const std::vector<const XmlNode*> emitters = p.objects("emitter");
    if (bsdfs.size() > 1)
        p.node().refuse("shape with two bsdfs (expected one)");
    if (emitters.size() > 1)
        p.node().refuse("shape with two emitters (expected one)");
    Surface surface;
    if (!bsdfs.empty()) {
        const MaterialSides sides = materials_.sides(*bsdfs.front());
        surface.front = sides.front;
        surface.back = sides.back;
    } else if (emitters.empty()) {
        // Mitsuba's default: diffuse 0.5 on the front, and black for emitters.
        surface.front = materials_.diffuse({0.5f, 0.5f, 0.5f});
    }
    if (!emitters.empty())
        surface.emission = load_area_emitter(context_, *emitters.front());
    return surface;
}

} // namespace plumb
