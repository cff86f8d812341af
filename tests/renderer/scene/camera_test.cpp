/// \file  The perspective camera: which way rays go, by trigonometry.

#include "renderer/scene/camera.h"
#include "renderer/scene/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumb::test {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

CameraDescription with_fov(double fov_deg, FovAxis axis = FovAxis::x) {
    CameraDescription d;
    d.fov_deg = fov_deg;
    d.fov_axis = axis;
    return d;
}

/// Tangents of the angles at the right and the upper edge of the image (camera space, z = 1).
Vec2 half_tangents(const Camera& camera) {
    const Vec3 right = camera.ray_through({1, 0.5f}).direction;
    const Vec3 top = camera.ray_through({0.5f, 0}).direction;
    return {std::fabs(right.x / right.z), std::fabs(top.y / top.z)};
}

void expect_near(Vec3 found, Vec3 wanted, float tolerance) {
    EXPECT_NEAR(found.x, wanted.x, tolerance);
    EXPECT_NEAR(found.y, wanted.y, tolerance);
    EXPECT_NEAR(found.z, wanted.z, tolerance);
}

/// corrections.md, pixel row: x = 2 (i + 1/2)/W - 1.
TEST(PixelCenter, RunsFromMinusSevenEighthsToSevenEighthsOverEightPixels) {
    for (int i = 0; i < 8; ++i) {
        const Vec2 ndc = pixel_center_ndc(i, i, 8, 8);
        EXPECT_EQ(ndc.x, -0.875f + 0.25f * static_cast<float>(i));
        EXPECT_EQ(ndc.y, 0.875f - 0.25f * static_cast<float>(i));
    }
    EXPECT_EQ(pixel_center_ndc(0, 0, 1, 1).x, 0.0f);
    EXPECT_EQ(pixel_center_ndc(0, 0, 1, 1).y, 0.0f);
}

/// ... then times tan(fov/2) and the aspect ratio: the image is in [0,1]^2 and +x is on its left.
TEST(Camera, SendsPixelCentresWhereTheirNormalizedCoordinatesSay) {
    const int width = 8, height = 4;
    const Camera camera = make_camera(with_fov(70), width, height);
    const double tangent = std::tan(35 * degree);
    for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i) {
            const Vec2 ndc = pixel_center_ndc(i, j, width, height);
            const Vec2 image{(static_cast<float>(i) + 0.5f) / 8,
                             (static_cast<float>(j) + 0.5f) / 4};
            const Vec3 d = camera.ray_through(image).direction;
            EXPECT_NEAR(d.x, -static_cast<double>(ndc.x) * tangent, 1e-6);
            EXPECT_NEAR(d.y, static_cast<double>(ndc.y) * tangent * height / width, 1e-6);
            EXPECT_EQ(d.z, 1.0f);
        }
}

TEST(Camera, ShowsPlusXOnTheLeftAndPlusYAtTheTop) {
    const Camera camera = make_camera(with_fov(60), 100, 100);
    const Vec3 upper_left = camera.ray_through({0, 0}).direction;
    const Vec3 lower_right = camera.ray_through({1, 1}).direction;
    EXPECT_GT(upper_left.x, 0);
    EXPECT_GT(upper_left.y, 0);
    EXPECT_LT(lower_right.x, 0);
    EXPECT_LT(lower_right.y, 0);
    expect_near(camera.ray_through({0.5f, 0.5f}).direction, {0, 0, 1}, 1e-7f);
}

TEST(Camera, AppliesTheFieldOfViewToTheNamedAxis) {
    const double tangent = std::tan(25 * degree);
    const struct {
        FovAxis axis;
        int width, height;
        double x, y;
    } cases[] = {
        {FovAxis::x, 200, 100, tangent, tangent / 2},
        {FovAxis::x, 100, 200, tangent, tangent * 2},
        {FovAxis::y, 200, 100, tangent * 2, tangent},
        {FovAxis::y, 100, 200, tangent / 2, tangent},
        {FovAxis::smaller, 200, 100, tangent * 2, tangent},
        {FovAxis::smaller, 100, 200, tangent, tangent * 2},
        {FovAxis::smaller, 100, 100, tangent, tangent},
        {FovAxis::larger, 200, 100, tangent, tangent / 2},
        {FovAxis::larger, 100, 200, tangent / 2, tangent},
        {FovAxis::larger, 100, 100, tangent, tangent},
        {FovAxis::diagonal, 400, 300, tangent * 0.8, tangent * 0.6},
        {FovAxis::diagonal, 300, 400, tangent * 0.6, tangent * 0.8},
    };
    for (const auto& c : cases) {
        const Vec2 found = half_tangents(make_camera(with_fov(50, c.axis), c.width, c.height));
        EXPECT_NEAR(found.x, c.x, 1e-6) << static_cast<int>(c.axis) << ' ' << c.width;
        EXPECT_NEAR(found.y, c.y, 1e-6) << static_cast<int>(c.axis) << ' ' << c.width;
    }
}

/// Mitsuba 3's perspective sensor adds the offset to the sample's position on the film.
TEST(Camera, MovesTheViewTowardsThePrincipalPointOffset) {
    CameraDescription d = with_fov(80);
    const Camera centred = make_camera(d, 160, 90);
    d.principal_x = 0.25;
    d.principal_y = -0.125;
    const Camera moved = make_camera(d, 160, 90);
    for (const float x : {0.0f, 0.25f, 0.5f, 1.0f})
        for (const float y : {0.0f, 0.5f, 0.75f})
            expect_near(moved.ray_through({x, y}).direction,
                        centred.ray_through({x + 0.25f, y - 0.125f}).direction, 5e-7f);
    // Towards the right of the image, which is -x, and upwards.
    const Vec3 middle = moved.ray_through({0.5f, 0.5f}).direction;
    EXPECT_NEAR(middle.x, -0.5 * std::tan(40 * degree), 1e-6);
    EXPECT_NEAR(middle.y, 0.25 * std::tan(40 * degree) * 90 / 160, 1e-6);
}

TEST(Camera, LooksFromTheOriginToTheTarget) {
    CameraDescription d = with_fov(40);
    const Vec3 origin{3, -2, 5}, target{-1, 4, 2};
    d.to_world = Transform::look_at(origin, target, {0, 0, 1}).value();
    const Camera camera = make_camera(d, 64, 64);
    const Vec3 view = normalize(target - origin);
    EXPECT_EQ(camera.origin, origin);
    expect_near(camera.forward, view, 1e-6f);
    expect_near(camera.ray_through({0.5f, 0.5f}).direction, view, 1e-6f);
    // Up in the image is up in the world, left is up x view.
    const Vec3 up = camera.ray_through({0.5f, 0}).direction - view;
    const Vec3 left = camera.ray_through({0, 0.5f}).direction - view;
    EXPECT_GT(up.z, 0);
    EXPECT_NEAR(dot(up, view), 0, 1e-6);
    expect_near(normalize(left), normalize(cross({0, 0, 1}, view)), 1e-6f);
    EXPECT_NEAR(length(left), std::tan(20 * degree), 1e-6);
}

/// The direction's length along the view is 1, so t is depth for every pixel.
TEST(Camera, ClipsAtDepthsInWorldUnitsWhateverThePixel) {
    CameraDescription d = with_fov(100);
    d.near_clip = 0.5;
    d.far_clip = 20;
    d.to_world = Transform::look_at({1, 2, 3}, {4, 5, 6}, {0, 1, 0}).value() *
                 Transform::scale(3, 3, 3); // must not change the depths
    const Camera camera = make_camera(d, 64, 48);
    EXPECT_NEAR(length(camera.forward), 1, 1e-6);
    for (const float x : {0.0f, 0.3f, 1.0f})
        for (const float y : {0.0f, 0.6f, 1.0f}) {
            const Ray ray = camera.ray_through({x, y});
            EXPECT_TRUE(is_valid(ray));
            EXPECT_NEAR(dot(ray.direction, camera.forward), 1, 1e-6);
            EXPECT_EQ(ray.tmin, 0.5f);
            EXPECT_EQ(ray.tmax, 20.0f);
        }
    EXPECT_NEAR(half_tangents(make_camera(with_fov(100), 64, 48)).x, std::tan(50 * degree), 1e-6);
    const Vec3 edge = camera.ray_through({1, 0.5f}).direction - camera.forward;
    EXPECT_NEAR(length(edge), std::tan(50 * degree), 2e-6);
}

TEST(Camera, IsMirroredByANegativeScale) {
    CameraDescription d = with_fov(60);
    d.to_world = Transform::scale(-1, 1, 1);
    EXPECT_LT(make_camera(d, 10, 10).ray_through({0, 0.5f}).direction.x, 0);
}

TEST(Camera, StaysFiniteAtTheEndsOfTheFieldOfView) {
    for (const double fov : {1e-3, 179.9})
        for (const FovAxis axis : {FovAxis::x, FovAxis::y, FovAxis::diagonal}) {
            const Camera camera = make_camera(with_fov(fov, axis), 3, 2);
            EXPECT_TRUE(is_valid(camera.ray_through({0, 1})));
        }
}

} // namespace
} // namespace plumb::test
