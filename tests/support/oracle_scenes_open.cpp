#include "tests/support/oracle_parts.h"
#include "tests/support/oracle_scenes.h"

#include <fmt/format.h>

namespace plumb::test {
namespace {

std::string receiver_under(const std::string& lights) {
    return scene_text(camera_on_origin(), receiver() + lights);
}

/// Irradiance pi L (r/d)^2 cos(theta): wholly above the horizon as long as theta + asin(r/d) < 90°.
Oracle sphere_light(std::string name, double theta_deg, double distance, double radius) {
    const double theta = theta_deg * pi_double / 180, phi = 0.6;
    const Double3 centre{distance * std::sin(theta) * std::cos(phi),
                         distance * std::sin(theta) * std::sin(phi), distance * std::cos(theta)};
    Oracle oracle = one_bounce(
        std::move(name), receiver_under(sphere(centre, radius, black_emitter(light_of_three))),
        pi_double * radius * radius / (distance * distance) * std::cos(theta));
    oracle.by_area = {Estimator::mis};
    return oracle;
}

/// Irradiance pi L r^2 / (r^2 + h^2).
Oracle disk_light() {
    const double r = 1.3, h = 0.8;
    const std::string place =
        fmt::format(R"(<scale value="{}"/><rotate x="1" angle="180"/><translate z="{}"/>)", r, h);
    Oracle oracle = one_bounce("disk_light",
                               receiver_under(shape("disk", place, black_emitter(light_of_three))),
                               pi_double * r * r / (r * r + h * h));
    oracle.by_area = {Estimator::mis, Estimator::light};
    return oracle;
}

/// The sky through a black tube: a cap of half-angle atan(r/h), irradiance pi L sin^2.
Oracle sky_through_tube() {
    const double r = 1.4, h = 0.8;
    const std::string tube =
        fmt::format(R"(<shape type="cylinder"><point name="p0" value="0, 0, -0.1"/>)"
                    R"(<point name="p1" value="0, 0, {}"/><float name="radius" value="{}"/>)"
                    R"(<transform name="to_world">{}</transform>{}</shape>)",
                    h, r, moved, twosided({0, 0, 0}));
    return one_bounce("sky_through_tube",
                      scene_text(camera_at({-0.5, 0.2, 0.45}, {0, 0, 0}, up_z, 0.02),
                                 receiver() + tube + constant_emitter(light_of_three)),
                      pi_double * r * r / (r * r + h * h));
}

/// Irradiance I cos(theta) / d^2, the light on a slant.
Oracle point_light() {
    const Double3 position{0.9, -0.5, 1.3};
    const double d2 = dot(position, position);
    return one_bounce("point_light", receiver_under(point_emitter(position, {6, 3, 4})),
                      position[2] / std::sqrt(d2) / d2, {6, 3, 4});
}

/// A body that cannot see itself: rho L.
Oracle under_sky(std::string name, const std::string& camera, const std::string& body) {
    return one_bounce(std::move(name), scene_text(camera, body + constant_emitter(light_of_three)),
                      pi_double);
}

} // namespace

std::vector<Oracle> sky_oracles() {
    const std::string turned =
        R"(<scale x="0.9" y="0.6" z="0.7"/><rotate x="1" y="2" z="-1" angle="50"/>)";
    const std::string plane = R"(<scale value="300"/>)";
    return {under_sky("sphere_under_sky", camera_at({0.3, -3, 0.7}, {0, 0, 0}, up_z, 20),
                      sphere({0, 0, 0}, 0.9, diffuse(receiver_albedo))),
            under_sky("cube_under_sky", camera_at({0.3, -3, 0.7}, {0, 0, 0}, up_z, 8),
                      shape("cube", turned, diffuse(receiver_albedo))),
            // The back of a two-sided plane; the mean irradiance is pi L.
            under_sky("plane_under_sky", camera_at({0.3, -1, -1.4}, {0.2, 0.5, 0}, up_z, 30),
                      shape("rectangle", plane, twosided(receiver_albedo))),
            sky_through_tube()};
}

std::vector<Oracle> round_light_oracles() {
    return {sphere_light("sphere_light", 30, 1.6, 1.2),
            sphere_light("spherical_cap", 0, 1.5, 1.2), // half-angle asin(0.8), on the axis
            disk_light(), point_light()};
}

} // namespace plumb::test
