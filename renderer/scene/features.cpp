#include "renderer/scene/features.h"

namespace plumb {

Features features_of(const Scene& scene) {
    Features f;
    f.spheres = !scene.spheres.empty();
    f.point_lights = !scene.point_lights.empty();
    f.environment = !is_black(scene.environment);
    std::size_t lights = scene.point_lights.size() + (f.environment ? 1u : 0u);
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        const Mesh& mesh = scene.meshes[i];
        f.smooth_normals |= !mesh.normals.empty();
        if (is_black(scene.surfaces[i].emission))
            continue;
        f.triangle_lights |= !mesh.is_rectangle;
        lights += mesh.is_rectangle ? 1 : mesh.triangles.size();
    }
    for (std::size_t i = scene.meshes.size(); i < scene.surfaces.size(); ++i)
        lights += is_black(scene.surfaces[i].emission) ? 0u : 1u;
    f.many_lights = lights > 1;
    return f;
}

std::string_view profile_name(const Features& needed) {
    return box_profile.covers(needed) ? "box" : "full";
}

} // namespace plumb
