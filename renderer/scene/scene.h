/// \file  The scene: the one owner of everything that a render reads.
#pragma once

#include "accel/geometry.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/rgb.h"
#include "renderer/scene/settings.h"

#include <memory>
#include <string>
#include <vector>

namespace plumb {

enum class MaterialKind : std::uint8_t { diffuse };

/// Lambertian reflection: radiance albedo / pi times irradiance.
struct Material {
    MaterialKind kind = MaterialKind::diffuse;
    Rgb reflectance{0.5f, 0.5f, 0.5f}; ///< each in [0,1]
};

/// What covers a mesh or a sphere. A side without a material absorbs all light.
struct Surface {
    std::uint32_t front = invalid_id; ///< material on the side of the normal
    std::uint32_t back = invalid_id;
    Rgb emission;             ///< radiance leaving the front, W sr^-1 m^-2; black: no light
    bool flip_normal = false; ///< spheres only: the front is inside. Meshes swap vertices.
};

/// An indexed triangle mesh in world space. The front is the counter-clockwise side.
struct Mesh {
    std::string name; ///< for messages: the shape's id, or its file name, or its plugin
    std::vector<Vec3> positions;
    std::vector<Vec3> normals; ///< unit shading normals, one a vertex; empty: flat
    std::vector<Vec2> uvs;     ///< one a vertex; empty: none
    std::vector<Triangle> triangles;
    /// Set by the rectangle shape: triangles (0,1,2), (2,3,0) over 4 positions with right angles.
    bool is_rectangle = false;
};

struct PointLight {
    Vec3 position;
    Rgb intensity; ///< W sr^-1
};

/// Everything that load_scene reads from a scene file. Plain values.
struct Scene {
    std::vector<Mesh> meshes;
    std::vector<Sphere> spheres;
    std::vector<Surface> surfaces; ///< one a mesh, then one a sphere
    std::vector<Material> materials;
    std::vector<PointLight> point_lights;
    Rgb environment; ///< constant radiance from all directions; black: none
    CameraDescription camera;
    FilmSettings film;
    SamplerSettings sampler;
    PathSettings path;

    std::vector<std::string> warnings; ///< one line each, with file and line
    std::vector<std::string> ignored;  ///< import report: properties that change no pixel

    [[nodiscard]] std::size_t triangle_count() const;
};

} // namespace plumb
