/// \file  Reading of the perspective camera.
#include "renderer/io/load_sensor.h"

#include "renderer/io/load_film.h"
#include "renderer/io/load_properties.h"
#include "renderer/io/load_sampler.h"
#include "renderer/io/parse_number.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace plumb {
namespace {

/// Millimetres of a 36 x 24 mm frame, such as "50mm", to degrees over its diagonal.
double fov_of_focal_length(Properties& p) {
    const XmlAttribute* value = p.string("focal_length");
    std::string_view text = value ? value->value : "50mm";
    if (text.ends_with("mm"))
        text.remove_suffix(2);
    const auto millimetres = parse_double(text);
    if (!millimetres || !(*millimetres > 0))
        p.refuse("focal_length", "millimetres such as '50mm'");
    const double diagonal = std::hypot(36.0, 24.0);
    return 2 * std::atan(diagonal / (2 * *millimetres)) * 180 / 3.14159265358979323846;
}

void load_fov(Properties& p, CameraDescription& camera) {
    constexpr std::array axes{FovAxis::x, FovAxis::y, FovAxis::diagonal, FovAxis::smaller,
                              FovAxis::larger};
    camera.fov_axis = axes[p.choice("fov_axis", 0, {"x", "y", "diagonal", "smaller", "larger"})];
    if (!p.has("fov")) {
        camera.fov_deg = fov_of_focal_length(p);
        camera.fov_axis = FovAxis::diagonal;
        return;
    }
    if (p.has("focal_length"))
        p.node().refuse("sensor with both 'fov' and 'focal_length' (expected one)");
    camera.fov_deg = p.number("fov", 0);
    if (!(camera.fov_deg > 0 && camera.fov_deg < 180))
        p.refuse("fov", "degrees above 0 and below 180");
}

void load_camera(Properties& p, CameraDescription& camera) {
    load_fov(p, camera);
    camera.principal_x = p.number("principal_point_offset_x", 0);
    camera.principal_y = p.number("principal_point_offset_y", 0);
    camera.near_clip = p.positive("near_clip", 1e-2);
    camera.far_clip = p.positive("far_clip", 1e4);
    if (!(camera.near_clip < camera.far_clip))
        p.refuse(
            p.has("far_clip") ? "far_clip" : "near_clip",
            fmt::format("near_clip ({}) below far_clip ({})", camera.near_clip, camera.far_clip));
    camera.to_world = p.transform("to_world");
}

/// The nested object of one kind; null if there is none.
const XmlNode* only_object(Properties& p, std::string_view element) {
    const std::vector<const XmlNode*> found = p.objects(element);
    if (found.size() > 1)
        found[1]->refuse(fmt::format("second <{}> in one sensor (expected one)", element));
    return found.empty() ? nullptr : found.front();
}

} // namespace

void load_sensor(LoadContext& context, const XmlNode& sensor) {
    const std::string_view plugin = context.plugin(sensor, {"perspective"}, "taken as perspective");
    Properties p(context, sensor);
    if (const XmlNode* film = only_object(p, "film"))
        load_film(context, *film);
    if (const XmlNode* sampler = only_object(p, "sampler"))
        load_sampler(context, *sampler);
    load_camera(p, context.scene.camera);
    // A pinhole has no focus, and nothing moves.
    p.changes_no_pixel({"focus_distance", "shutter_open", "shutter_close"});
    p.not_supported({"srf", "kc", "x_fov"});
    if (plugin.empty())
        p.ignore_rest();
    p.finish();
}

} // namespace plumb
