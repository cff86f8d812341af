#include "renderer/scene/scene_tables.h"

#include <cmath>

namespace plumb {
namespace {

constexpr double pi_double = 3.14159265358979323846;

/// Radius of a sphere around all geometry; 1 for an empty scene.
double scene_radius(const GeometryView& geometry) {
    Bounds bounds;
    for (const MeshView& mesh : geometry.meshes)
        for (const Vec3 p : mesh.positions)
            bounds.extend(p);
    for (const Sphere& sphere : geometry.spheres)
        bounds.extend(sphere_bounds(sphere));
    if (bounds.empty())
        return 1;
    return 0.5 * static_cast<double>(length(bounds.extent()));
}

/// Radiant flux up to a factor common to all lights, luminance-weighted.
double power(const Light& light, double radius_of_scene) {
    const double emission = static_cast<double>(luminance(light.emission));
    switch (light.kind) {
    case LightKind::triangle:
    case LightKind::rectangle:
    case LightKind::sphere: return emission * pi_double * static_cast<double>(light.area);
    case LightKind::point: return emission * 4 * pi_double;
    case LightKind::environment:
        return emission * 4 * pi_double * pi_double * radius_of_scene * radius_of_scene;
    }
    return 0;
}

} // namespace

std::size_t Scene::triangle_count() const {
    std::size_t count = 0;
    for (const Mesh& mesh : meshes)
        count += mesh.triangles.size();
    return count;
}

SceneTables::SceneTables(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes) {
        meshes_.push_back({mesh.positions, mesh.triangles});
        normals_.emplace_back(mesh.normals);
    }
    view_.geometry = {meshes_, scene.spheres};
    add_surface_lights(scene);
    for (const PointLight& point : scene.point_lights) {
        Light light;
        light.kind = LightKind::point;
        light.emission = point.intensity;
        light.origin = point.position;
        lights_.push_back(light);
    }
    if (!is_black(scene.environment)) {
        Light light;
        light.kind = LightKind::environment;
        light.emission = scene.environment;
        view_.environment = static_cast<std::uint32_t>(lights_.size());
        lights_.push_back(light);
    }
    choose_by_power();
    view_.normals = normals_;
    view_.surfaces = scene.surfaces;
    view_.surface_lights = surface_lights_;
    view_.materials = scene.materials;
    view_.lights = lights_;
    view_.light_cdf = light_cdf_;
    view_.camera = make_camera(scene.camera, scene.film.width, scene.film.height);
}

void SceneTables::add_surface_lights(const Scene& scene) {
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
        const Surface& surface = scene.surfaces[i];
        SurfaceLights& mine = surface_lights_.emplace_back();
        if (is_black(surface.emission))
            continue;
        mine.first = static_cast<std::uint32_t>(lights_.size());
        if (i < scene.meshes.size()) {
            mine.per_primitive = !scene.meshes[i].is_rectangle;
            add_mesh_lights(scene.meshes[i], surface);
            continue;
        }
        const Sphere& sphere = scene.spheres[i - scene.meshes.size()];
        Light light;
        light.kind = LightKind::sphere;
        light.inside_out = surface.flip_normal;
        light.emission = surface.emission;
        light.origin = sphere.center;
        light.radius = sphere.radius;
        light.area = 4 * pi * sphere.radius * sphere.radius;
        lights_.push_back(light);
    }
}

void SceneTables::add_mesh_lights(const Mesh& mesh, const Surface& surface) {
    const auto vertices = [&](const Triangle& t) {
        return TriangleVertices{mesh.positions[t.a], mesh.positions[t.b], mesh.positions[t.c]};
    };
    if (!mesh.is_rectangle) {
        for (const Triangle& t : mesh.triangles)
            add_triangle_light(vertices(t), surface.emission);
        return;
    }
    add_triangle_light(vertices(mesh.triangles[0]), surface.emission);
    Light& light = lights_.back(); // triangle (a, b, c): right angle at b
    const TriangleVertices t = vertices(mesh.triangles[0]);
    light.kind = LightKind::rectangle;
    light.origin = t.a;
    light.edge1 = t.b - t.a;
    light.edge2 = t.c - t.b;
    light.area *= 2;
}

void SceneTables::add_triangle_light(const TriangleVertices& t, Rgb emission) {
    const Vec3 n = cross(t.b - t.a, t.c - t.a);
    Light light;
    light.kind = LightKind::triangle;
    light.emission = emission;
    light.origin = t.a;
    light.edge1 = t.b - t.a;
    light.edge2 = t.c - t.a;
    light.normal = safe_normalize(n);
    light.area = 0.5f * length(n);
    lights_.push_back(light);
}

void SceneTables::choose_by_power() {
    if (lights_.empty())
        return;
    const double radius = scene_radius(view_.geometry);
    std::vector<double> sums{0};
    for (const Light& light : lights_)
        sums.push_back(sums.back() + power(light, radius));
    if (!(sums.back() > 0)) { // zero area everywhere: no light is ever hit or sampled
        lights_.clear();
        for (SurfaceLights& mine : surface_lights_)
            mine = {};
        view_.environment = invalid_id;
        return;
    }
    for (const double sum : sums)
        light_cdf_.push_back(static_cast<float>(sum / sums.back()));
    for (std::size_t i = 0; i < lights_.size(); ++i)
        lights_[i].probability = light_cdf_[i + 1] - light_cdf_[i];
}

} // namespace plumb
