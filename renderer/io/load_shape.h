/// \file  <shape> elements.
#pragma once

#include "renderer/io/load_context.h"
#include "renderer/io/load_material.h"

namespace plumb {

class Properties;

/// Turns shape elements into meshes and spheres with their surfaces.
class ShapeLoader {
  public:
    ShapeLoader(LoadContext& context, MaterialLoader& materials)
        : context_(context), materials_(materials) {}

    /// Throws SceneError.
    void load(const XmlNode& shape);
    /// Puts the surfaces into the scene: those of the meshes, then those of the spheres.
    void finish();

  private:
    Mesh load_mesh(Properties& p, std::string_view plugin);
    Mesh load_mesh_file(Properties& p, std::string_view plugin);
    Sphere load_sphere(Properties& p);
    Surface load_surface(Properties& p);

    LoadContext& context_;
    MaterialLoader& materials_;
    std::vector<Surface> mesh_surfaces_, sphere_surfaces_;
};

} // namespace plumb
