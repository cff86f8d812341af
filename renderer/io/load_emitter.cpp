/// \file  Reading of emitters.
#include "renderer/io/load_emitter.h"

#include "renderer/io/load_properties.h"

#include <limits>

namespace plumb {
namespace {

constexpr Rgb unit{1, 1, 1};
constexpr float unbounded = std::numeric_limits<float>::max();

void load_point(LoadContext& context, const XmlNode& emitter) {
    Properties p(context, emitter);
    PointLight light;
    if (p.has("position") && p.has("to_world"))
        emitter.refuse("emitter 'point' with both 'position' and 'to_world' (expected one)");
    const Transform to_world = p.transform("to_world");
    light.position = p.point("position", to_world.point({0, 0, 0}));
    light.intensity = p.colour("intensity", unit, 0, unbounded);
    p.changes_no_pixel({"sampling_weight"});
    p.finish();
    context.scene.point_lights.push_back(light);
}

void load_constant(LoadContext& context, const XmlNode& emitter) {
    if (!is_black(context.scene.environment))
        emitter.refuse("second environment emitter (expected one)");
    Properties p(context, emitter);
    context.scene.environment = p.colour("radiance", unit, 0, unbounded);
    p.changes_no_pixel({"sampling_weight", "to_world"});
    p.finish();
}

} // namespace

bool load_emitter(LoadContext& context, const XmlNode& emitter) {
    if (emitter.value_or_empty("type") == "area") {
        context.unsupported(emitter, "emitter 'area' outside a shape (expected inside <shape>)",
                            "left out");
        return false;
    }
    const std::string_view plugin = context.plugin(emitter, {"point", "constant"}, "left out");
    if (plugin == "point")
        load_point(context, emitter);
    else if (plugin == "constant")
        load_constant(context, emitter);
    return !plugin.empty();
}

Rgb load_area_emitter(LoadContext& context, const XmlNode& emitter) {
    if (context.plugin(emitter, {"area"}, "left out").empty())
        return {};
    Properties p(context, emitter);
    const Rgb radiance = p.colour("radiance", unit, 0, unbounded);
    p.changes_no_pixel({"sampling_weight"});
    p.finish();
    return radiance;
}

} // namespace plumb
