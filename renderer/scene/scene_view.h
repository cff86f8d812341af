/// \file  What kernels read of a scene, host and device: trivially copyable spans.
#pragma once

#include "accel/geometry.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/light.h"
#include "renderer/scene/scene.h"

#include <span>

namespace plumb {

/// Which lights a surface carries: its primitive p is light first + (per_primitive ? p : 0).
struct SurfaceLights {
    std::uint32_t first = invalid_id; ///< invalid_id: none
    bool per_primitive = false;
};

struct SceneView {
    GeometryView geometry;
    std::span<const std::span<const Vec3>> normals; ///< one a mesh; an empty span: flat
    std::span<const Surface> surfaces;              ///< one a mesh, then one a sphere
    std::span<const SurfaceLights> surface_lights;  ///< likewise
    std::span<const Material> materials;
    std::span<const Light> lights;
    std::span<const float> light_cdf;       ///< lights.size() + 1, or empty without lights
    std::uint32_t environment = invalid_id; ///< its light, or invalid_id
    Camera camera;

    [[nodiscard]] RT_HD std::uint32_t surface_of(const Hit& hit) const {
        return geometry.is_sphere(hit.geometry) ? hit.geometry + hit.primitive : hit.geometry;
    }
};

} // namespace plumb
