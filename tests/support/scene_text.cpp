#include "tests/support/scene_text.h"

#include <cmath>
#include <fmt/format.h>

namespace plumb::test {

double dot(const Double3& a, const Double3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Double3 cross(const Double3& a, const Double3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Double3 normalized(const Double3& a) { return (1 / std::sqrt(dot(a, a))) * a; }

std::string text_of(const Double3& v) { return fmt::format("{}, {}, {}", v[0], v[1], v[2]); }

std::string scene_text(std::string_view camera, std::string_view body) {
    return fmt::format(R"(<scene version="3.0.0">
<default name="side" value="8"/><default name="spp" value="1"/><default name="seed" value="0"/>
<integrator type="path"/>
<sensor type="perspective">{}
<film type="hdrfilm"><integer name="width" value="$side"/><integer name="height" value="$side"/>
<rfilter type="box"/></film>
<sampler type="independent"><integer name="sample_count" value="$spp"/>
<integer name="seed" value="$seed"/></sampler>
</sensor>
{}
</scene>
)",
                       camera, body);
}

std::string camera_at(const Double3& origin, const Double3& target, const Double3& up,
                      double fov_deg, std::string_view then) {
    return fmt::format(R"(<float name="fov" value="{}"/><transform name="to_world">)"
                       R"(<lookat origin="{}" target="{}" up="{}"/>{}</transform>)",
                       fov_deg, text_of(origin), text_of(target), text_of(up), then);
}

std::string diffuse(const Double3& reflectance) {
    return fmt::format(R"(<bsdf type="diffuse"><rgb name="reflectance" value="{}"/></bsdf>)",
                       text_of(reflectance));
}

std::string twosided(const Double3& reflectance) {
    return fmt::format(R"(<bsdf type="twosided">{}</bsdf>)", diffuse(reflectance));
}

std::string area_emitter(const Double3& radiance) {
    return fmt::format(R"(<emitter type="area"><rgb name="radiance" value="{}"/></emitter>)",
                       text_of(radiance));
}

std::string constant_emitter(const Double3& radiance) {
    return fmt::format(R"(<emitter type="constant"><rgb name="radiance" value="{}"/></emitter>)",
                       text_of(radiance));
}

std::string point_emitter(const Double3& position, const Double3& intensity) {
    return fmt::format(
        R"(<emitter type="point"><rgb name="intensity" value="{}"/><transform name="to_world">)"
        R"(<translate value="{}"/>{}</transform></emitter>)",
        text_of(intensity), text_of(position), moved);
}

std::string black_emitter(const Double3& radiance) {
    return diffuse({0, 0, 0}) + area_emitter(radiance);
}

std::string shape(std::string_view type, std::string_view transform, std::string_view inside) {
    return fmt::format(R"(<shape type="{}"><transform name="to_world">{}{}</transform>{}</shape>)"
                       "\n",
                       type, transform, moved, inside);
}

std::string rectangle(const Double3& centre, const Double3& half_x, const Double3& half_y,
                      std::string_view inside) {
    const Double3 n = normalized(cross(half_x, half_y));
    std::string rows;
    for (std::size_t i = 0; i < 3; ++i)
        rows += fmt::format("{} {} {} {} ", half_x[i], half_y[i], n[i], centre[i]);
    return shape("rectangle", fmt::format(R"(<matrix value="{}0 0 0 1"/>)", rows), inside);
}

std::string sphere(const Double3& centre, double radius, std::string_view inside) {
    return shape(
        "sphere",
        fmt::format(R"(<scale value="{}"/><translate value="{}"/>)", radius, text_of(centre)),
        inside);
}

} // namespace plumb::test
