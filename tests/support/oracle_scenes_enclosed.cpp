#include "tests/support/oracle_parts.h"
#include "tests/support/oracle_scenes.h"

#include <fmt/format.h>

namespace plumb::test {
namespace {

/// Darker than other walls: between a white lamp and brighter walls, a constant roulette and
/// uniform bounces come close to an infinite variance.
constexpr Double3 cavity_albedo{0.4, 0.2, 0.3};

constexpr std::string_view inside_out = R"(<boolean name="flip_normals" value="true"/>)";

/// a (1 + r + r^2 + ...), all of it or `terms` terms.
double series(double a, double r) { return a / (1 - r); }
double series(double a, double r, int terms) { return a * (1 - std::pow(r, terms)) / (1 - r); }

/// Every wall emits and reflects: E / (1 - rho), E (1 - rho^D) / (1 - rho) of D segments.
Oracle furnace(std::string name, const std::string& camera, const std::string& body) {
    Oracle oracle;
    oracle.name = std::move(name);
    oracle.xml = scene_text(camera, body);
    for (std::size_t c = 0; c < 3; ++c) {
        oracle.expected[c] = series(light_of_three[c], wall_albedo[c]);
        oracle.expected_cut[c] = series(light_of_three[c], wall_albedo[c], depth_without_roulette);
        oracle.expected_alone[c] = series(light_of_three[c], wall_albedo[c], 2);
    }
    return oracle;
}

Oracle box_furnace() {
    return furnace(
        "box_furnace", camera_at({0.2, -0.1, 0.3}, {-0.4, 0.5, -1}, up_z, 50),
        shape("cube", R"(<scale x="1.1" y="0.8" z="1.4"/>)",
              diffuse(wall_albedo) + area_emitter(light_of_three) + std::string(inside_out)));
}

/// Two-sided walls, rectangles instead of triangles.
Oracle rectangle_furnace() {
    const double size[3] = {1.1, 0.8, 1.4};
    const std::string wall = twosided(wall_albedo) + area_emitter(light_of_three);
    std::string body;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Double3 centre{}, x{}, y{};
            centre[axis] = side * size[axis];
            x[(axis + 1) % 3] = -side * size[(axis + 1) % 3]; // x cross y points inwards
            y[(axis + 2) % 3] = size[(axis + 2) % 3];
            body += rectangle(centre, x, y, wall);
        }
    return furnace("rectangle_furnace", camera_at({0.2, -0.1, 0.3}, {-0.4, 0.5, -1}, up_z, 50),
                   body);
}

Oracle sphere_furnace() {
    return furnace(
        "sphere_furnace", camera_at({0.2, -0.5, 0.3}, {-0.4, 0.5, -1}, up_z, 40),
        sphere({0.1, 0.2, -0.1}, 1.3,
               diffuse(wall_albedo) + area_emitter(light_of_three) + std::string(inside_out)));
}

/// A point light at the centre of a sphere: direct radiance rho I / (pi R^2), then the furnace.
Oracle point_in_sphere(std::string name, double radius, const Double3& intensity,
                       const Double3& albedo) {
    Oracle oracle;
    oracle.name = std::move(name);
    oracle.xml = scene_text(camera_at({0.2, -0.5, 0.3}, {-0.4, 0.5, -1}, up_z, 40),
                            sphere({0, 0, 0}, radius, diffuse(albedo) + std::string(inside_out)) +
                                point_emitter({0, 0, 0}, intensity));
    for (std::size_t c = 0; c < 3; ++c) {
        const double direct = albedo[c] * intensity[c] / (pi_double * radius * radius);
        oracle.expected[c] = series(direct, albedo[c]);
        oracle.expected_cut[c] = series(direct, albedo[c], depth_without_roulette - 1);
        oracle.expected_alone[c] = direct;
    }
    return oracle;
}

/// A sphere whose cap of 95 degrees is closed by a flat lamp of albedo `lamp` (0 or 1). Whatever
/// reaches the wall from the cap crosses the lamp's disk, so the lamp stands for the cap exactly.
/// With albedo 1 it sends back all that it gets, as the cap would (which sees itself): the wall's
/// radiance is rho f E / (1 - rho) with f = (1 - cos 95°) / 2. Black, it is a hole:
/// rho f E / (1 - rho (1 - f)).
Oracle cavity(std::string name, double lamp) {
    const double cosine = std::cos(95 * pi_double / 180), radius = 1.2;
    const double f = (1 - cosine) / 2;
    Oracle oracle;
    oracle.name = std::move(name);
    const std::string disk =
        fmt::format(R"(<scale value="{}"/><rotate x="1" angle="180"/><translate z="{}"/>)",
                    radius * std::sqrt(1 - cosine * cosine), radius * cosine);
    oracle.xml = scene_text(
        camera_at({0.1, -0.5, -0.4}, {-0.3, 0.5, -1}, up_z, 20),
        sphere({0, 0, 0}, radius, diffuse(cavity_albedo) + std::string(inside_out)) +
            shape("disk", disk, diffuse({lamp, lamp, lamp}) + area_emitter(light_of_three)));
    for (std::size_t c = 0; c < 3; ++c) {
        const double rho = cavity_albedo[c], emitted = light_of_three[c];
        oracle.expected[c] = series(rho * f * emitted, lamp > 0 ? rho : rho * (1 - f));
        oracle.expected_alone[c] = rho * f * emitted;
        // Order by order: what leaves the wall and the lamp after one reflection more.
        double wall = 0, from_lamp = emitted;
        for (int segments = 2; segments <= depth_without_roulette; ++segments) {
            const double next = rho * ((1 - f) * wall + f * from_lamp);
            from_lamp = lamp * wall;
            wall = next;
            oracle.expected_cut[c] += wall;
        }
    }
    oracle.light_unbounded = true;
    return oracle;
}

} // namespace

std::vector<Oracle> enclosed_oracles() {
    return {box_furnace(),
            rectangle_furnace(),
            sphere_furnace(),
            point_in_sphere("point_in_unit_sphere", 1, {pi_double, pi_double, pi_double},
                            {0.5, 0.5, 0.5}), // radiance 1
            point_in_sphere("point_in_sphere", 1.6, {3, 2, 5}, wall_albedo),
            cavity("cavity", 1),
            cavity("cavity_with_hole", 0)};
}

} // namespace plumb::test
