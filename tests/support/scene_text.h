/// \file  Pieces of scene files for tests that render.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace plumb::test {

/// A point or direction of a closed form: the tests' own arithmetic is double.
using Double3 = std::array<double, 3>;

[[nodiscard]] inline Double3 operator+(const Double3& a, const Double3& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
[[nodiscard]] inline Double3 operator-(const Double3& a, const Double3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline Double3 operator*(double s, const Double3& a) {
    return {s * a[0], s * a[1], s * a[2]};
}
[[nodiscard]] double dot(const Double3& a, const Double3& b);
[[nodiscard]] Double3 cross(const Double3& a, const Double3& b);
[[nodiscard]] Double3 normalized(const Double3& a);

/// Transforms are given as XML elements. This one moves a whole scene off the axes: append it to
/// every to_world, so that nothing in a test is axis-aligned by chance.
inline constexpr std::string_view moved =
    R"(<rotate x="0.3" y="-0.8" z="0.52" angle="67"/><translate x="1.5" y="-2" z="0.7"/>)";

/// "x, y, z" with all digits.
[[nodiscard]] std::string text_of(const Double3& v);

/// A whole scene file: version 3, path integrator, square film of $side pixels (default 8), box
/// filter, independent sampler with $spp samples (default 1) and seed $seed (default 0). `camera`:
/// what camera_at gives.
[[nodiscard]] std::string scene_text(std::string_view camera, std::string_view body);

/// The sensor's fov and to_world.
[[nodiscard]] std::string camera_at(const Double3& origin, const Double3& target, const Double3& up,
                                    double fov_deg, std::string_view then = moved);

[[nodiscard]] std::string diffuse(const Double3& reflectance);
[[nodiscard]] std::string twosided(const Double3& reflectance);
[[nodiscard]] std::string area_emitter(const Double3& radiance);
[[nodiscard]] std::string constant_emitter(const Double3& radiance);
[[nodiscard]] std::string point_emitter(const Double3& position, const Double3& intensity);
/// A black area light's inside: no reflection.
[[nodiscard]] std::string black_emitter(const Double3& radiance);

/// A shape of `type` whose to_world is `transform`, then moved; `inside`: further elements.
[[nodiscard]] std::string shape(std::string_view type, std::string_view transform,
                                std::string_view inside);
/// A rectangle by its centre and half edges at right angles; its front looks along half_x x half_y.
[[nodiscard]] std::string rectangle(const Double3& centre, const Double3& half_x,
                                    const Double3& half_y, std::string_view inside);
[[nodiscard]] std::string sphere(const Double3& centre, double radius, std::string_view inside);

} // namespace plumb::test
