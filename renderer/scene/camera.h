/// \file  Perspective pinhole camera, host and device.
#pragma once

#include "accel/math/ray.h"
#include "accel/math/transform.h"

namespace plumb {

/// Image positions are in [0,1]^2 over the full film, (0,0) the upper left corner. The camera looks
/// along +z of its space with +y up; +x points to the left of the image, as Mitsuba has it.
struct Camera {
    Vec3 origin{0, 0, 0};
    /// World-space direction through (x, y): corner + x * dx + y * dy; its camera-space z is 1.
    Vec3 corner{1, 1, 1}, dx{-2, 0, 0}, dy{0, -2, 0};
    /// World-space unit view direction.
    Vec3 forward{0, 0, 1};
    float near_clip = 1e-2f, far_clip = 1e4f; ///< along `forward`, world units

    /// Ray with a direction whose length along `forward` is 1, so that t is the depth: tmin and
    /// tmax are the clip distances.
    [[nodiscard]] RT_HD Ray ray_through(Vec2 image) const {
        return {origin, near_clip, corner + dx * image.x + dy * image.y, far_clip};
    }
};

/// Normalized device coordinates in [-1,1] of the centre of pixel (i, j) in a W x H image:
/// x = 2 (i + 1/2)/W - 1 to the right, y = 1 - 2 (j + 1/2)/H up.
[[nodiscard]] RT_HD inline Vec2 pixel_center_ndc(int i, int j, int width, int height) {
    return {2 * (static_cast<float>(i) + 0.5f) / static_cast<float>(width) - 1,
            1 - 2 * (static_cast<float>(j) + 0.5f) / static_cast<float>(height)};
}

enum class FovAxis : std::uint8_t { x, y, diagonal, smaller, larger };

/// What a scene file says of a perspective sensor.
struct CameraDescription {
    double fov_deg = 39.3077; ///< full angle along fov_axis, in (0, 180)
    FovAxis fov_axis = FovAxis::x;
    /// Principal point offset, fractions of the film size: the ray through (x, y) is the one that a
    /// centred camera sends through (x + principal_x, y + principal_y), as Mitsuba 3 has it.
    double principal_x = 0, principal_y = 0;
    double near_clip = 1e-2, far_clip = 1e4;
    Transform to_world;
};

/// `width`, `height`: of the full film in pixels. The transform must be affine and invertible.
[[nodiscard]] Camera make_camera(const CameraDescription& description, int width, int height);

} // namespace plumb
