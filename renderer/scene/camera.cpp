#include "renderer/scene/camera.h"

#include <cmath>

namespace plumb {
namespace {

/// Tangents of half the horizontal and half the vertical field of view.
struct HalfTangents {
    double x, y;
};

HalfTangents half_tangents(const CameraDescription& d, double aspect) {
    const double tangent = std::tan(d.fov_deg * 3.14159265358979323846 / 360);
    switch (d.fov_axis) {
    case FovAxis::x: break;
    case FovAxis::y: return {tangent * aspect, tangent};
    case FovAxis::diagonal: {
        const double y = tangent / std::hypot(1.0, aspect);
        return {y * aspect, y};
    }
    case FovAxis::smaller:
        if (aspect > 1)
            return {tangent * aspect, tangent};
        break;
    case FovAxis::larger:
        if (aspect <= 1)
            return {tangent * aspect, tangent};
        break;
    }
    return {tangent, tangent / aspect};
}

Vec3 to_vec3(double x, double y, double z) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

} // namespace

Camera make_camera(const CameraDescription& d, int width, int height) {
    const HalfTangents half = half_tangents(d, static_cast<double>(width) / height);
    const Transform& world = d.to_world;
    // A scale in to_world stretches lengths along the view: clip distances are world units.
    const double stretch = std::hypot(world.m[0][2], world.m[1][2], world.m[2][2]);
    const auto direction = [&](double x, double y, double z) {
        return to_vec3((world.m[0][0] * x + world.m[0][1] * y + world.m[0][2] * z) / stretch,
                       (world.m[1][0] * x + world.m[1][1] * y + world.m[1][2] * z) / stretch,
                       (world.m[2][0] * x + world.m[2][1] * y + world.m[2][2] * z) / stretch);
    };
    Camera camera;
    camera.origin = world.point({0, 0, 0});
    camera.corner =
        direction(half.x * (1 - 2 * d.principal_x), half.y * (1 - 2 * d.principal_y), 1);
    camera.dx = direction(-2 * half.x, 0, 0);
    camera.dy = direction(0, -2 * half.y, 0);
    camera.forward = direction(0, 0, 1);
    camera.near_clip = static_cast<float>(d.near_clip);
    camera.far_clip = static_cast<float>(d.far_clip);
    return camera;
}

} // namespace plumb
