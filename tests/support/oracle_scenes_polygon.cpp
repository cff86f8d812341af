#include "tests/support/oracle_parts.h"
#include "tests/support/oracle_scenes.h"
#include "tests/support/polygon_irradiance.h"

#include <fmt/format.h>

namespace plumb::test {
namespace {

struct Plate {
    Double3 centre, half_x, half_y;

    [[nodiscard]] std::vector<Double3> corners() const {
        return {centre - half_x - half_y, centre + half_x - half_y, centre + half_x + half_y,
                centre - half_x + half_y};
    }
    [[nodiscard]] std::string lamp(const Double3& radiance) const {
        return rectangle(centre, half_x, half_y, black_emitter(radiance));
    }
};

/// A rectangle around `centre` that looks along `normal` (any length).
Plate plate(const Double3& centre, const Double3& normal, double half_width, double half_height) {
    const Double3 n = normalized(normal);
    const Double3 x = normalized(cross({0.3, 0.1, 1}, n));
    return {centre, half_width * x, half_height * cross(n, x)};
}

/// One face of any number of corners, its front on the counter-clockwise side.
std::string obj_of(const std::vector<Double3>& corners) {
    std::string text, face = "f";
    for (std::size_t i = 0; i < corners.size(); ++i) {
        text += fmt::format("v {} {} {}\n", corners[i][0], corners[i][1], corners[i][2]);
        face += fmt::format(" {}", i + 1);
    }
    return text + face + "\n";
}

std::string obj_lamp(std::string_view file, const Double3& radiance) {
    return shape("obj", "",
                 fmt::format(R"(<string name="filename" value="{}"/>)", file) +
                     black_emitter(radiance));
}

Oracle polygon_light(std::string name, const std::string& lamp,
                     const std::vector<Double3>& corners) {
    Oracle oracle = one_bounce(std::move(name), scene_text(camera_on_origin(), receiver() + lamp),
                               polygon_irradiance(corners));
    oracle.by_area = {Estimator::mis, Estimator::light};
    return oracle;
}

Oracle rectangle_light(std::string name, const Plate& p) {
    return polygon_light(std::move(name), p.lamp(light_of_three), p.corners());
}

Oracle mesh_light(std::string name, const std::vector<Double3>& corners) {
    Oracle oracle = polygon_light(std::move(name), obj_lamp("lamp.obj", light_of_three), corners);
    oracle.files["lamp.obj"] = obj_of(corners);
    return oracle;
}

const std::vector<Double3> slanted_triangle{{-1.6, 1.4, 0.7}, {1.5, 1.6, 1.3}, {1.1, -2.1, 0.9}};

/// Corners on an ellipse at irregular angles: convex, of five unequal sides.
std::vector<Double3> pentagon() {
    const Double3 centre{0.4, 0.1, 0.9}, n = normalized({-0.5, 0.2, -1});
    const Double3 x = normalized(cross({0, 1, 0.2}, n)), y = cross(n, x);
    std::vector<Double3> corners;
    for (const double angle : {0.1, 1.6, 2.5, 4.1, 5.4})
        corners.push_back(centre + 1.6 * std::cos(angle) * x + 1.1 * std::sin(angle) * y);
    return corners;
}

/// Lights of all kinds and of very different power, none before another: their sum.
Oracle mixed_lights() {
    const Plate high = plate({0.5, 0.8, 1.6}, {-0.2, -0.6, -1}, 0.8, 0.5);
    const Plate low = plate({1.3, -0.2, 0.5}, {-1, 0.1, -0.2}, 0.4, 0.3);
    const std::vector<Double3> three{{-1.6, 0.7, 0.6}, {-0.6, 1.7, 0.8}, {-0.9, 0.9, 1.8}};
    const Double3 ball{-0.2, -1.4, 1.1}, point{0.1, -0.3, 0.8};
    const double ball_radius = 0.6;
    const double point2 = dot(point, point), ball2 = dot(ball, ball);
    // Radiance 1 is light_of_three; the others are multiples of it.
    const double sum =
        polygon_irradiance(high.corners()) + 3 * polygon_irradiance(low.corners()) +
        2 * polygon_irradiance(three) +
        1.5 * pi_double * ball_radius * ball_radius / ball2 * ball[2] / std::sqrt(ball2) +
        0.2 * point[2] / (point2 * std::sqrt(point2));
    Oracle oracle = one_bounce(
        "mixed_lights",
        scene_text(camera_at({-0.9, -0.35, 0.3}, {0, 0, 0}, up_z, 0.02),
                   receiver() + high.lamp(light_of_three) + low.lamp(3 * light_of_three) +
                       obj_lamp("three.obj", 2 * light_of_three) +
                       sphere(ball, ball_radius, black_emitter(1.5 * light_of_three)) +
                       point_emitter(point, 0.2 * light_of_three)),
        sum);
    oracle.files["three.obj"] = obj_of(three);
    return oracle;
}

/// A camera between the plates sees exactly the square [-h, h]^2 at z = 0, each part alike.
std::string camera_on_square(double half, double height) {
    return camera_at({0, 0, height}, {0, 0, 0}, {0, 1, 0},
                     2 * std::atan(half / height) * 180 / pi_double);
}

std::string floor_of(double half) {
    return rectangle({0, 0, 0}, {half, 0, 0}, {0, half, 0}, diffuse(receiver_albedo));
}

/// Mean irradiance pi L F of a square of side a under another at distance d.
Oracle parallel_squares(std::string name, double a, double d) {
    const Plate lamp{{0, 0, d}, {a / 2, 0, 0}, {0, -a / 2, 0}};
    return one_bounce(
        std::move(name),
        scene_text(camera_on_square(a / 2, d / 2), floor_of(a / 2) + lamp.lamp(light_of_three)),
        pi_double * parallel_form_factor(a / d, a / d));
}

/// The same with a wall on the edge x = -a/2: F = 0.2000437761 for squares of any size. Sampling
/// the wall by area has unbounded variance here.
Oracle perpendicular_squares() {
    const double a = 1.7;
    const Plate lamp{{-a / 2, 0, a / 2}, {0, a / 2, 0}, {0, 0, a / 2}};
    return one_bounce(
        "perpendicular_squares",
        scene_text(camera_on_square(a / 2, a), floor_of(a / 2) + lamp.lamp(light_of_three)),
        pi_double * 0.2000437761);
}

} // namespace

std::vector<Oracle> polygon_oracles() {
    std::vector<Oracle> oracles{
        rectangle_light("rectangle_light", plate({0.4, -0.2, 1.1}, {-0.2, 0.5, -0.84}, 1.7, 1.1)),
        rectangle_light("rectangle_at_horizon", plate({0.6, 0.1, 0.3}, {-1, 0.1, -0.3}, 1.6, 0.9)),
        mesh_light("triangle_light", slanted_triangle),
        mesh_light("pentagon_light", pentagon()),
        mixed_lights(),
        parallel_squares("parallel_squares", 1.7, 0.7),
        perpendicular_squares()};
    oracles[5].by_area = {Estimator::mis, Estimator::light};
    return oracles;
}

} // namespace plumb::test
