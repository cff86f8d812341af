/// \file  Derived data of a scene: mesh views, lights and their distribution.
#pragma once

#include "renderer/scene/scene_view.h"

namespace plumb {

/// Built once from a Scene, which must outlive it unchanged. Owns what SceneView points to.
class SceneTables {
  public:
    explicit SceneTables(const Scene& scene);
    SceneTables(const SceneTables&) = delete;
    SceneTables& operator=(const SceneTables&) = delete;

    /// Geometry for make_intersector.
    [[nodiscard]] GeometryView geometry() const { return view_.geometry; }
    [[nodiscard]] const SceneView& view() const { return view_; }

  private:
    void add_surface_lights(const Scene& scene);
    void add_mesh_lights(const Mesh& mesh, const Surface& surface);
    void add_triangle_light(const TriangleVertices& t, Rgb emission);
    void choose_by_power();

    std::vector<MeshView> meshes_;
    std::vector<std::span<const Vec3>> normals_;
    std::vector<SurfaceLights> surface_lights_;
    std::vector<Light> lights_;
    std::vector<float> light_cdf_;
    SceneView view_;
};

} // namespace plumb
