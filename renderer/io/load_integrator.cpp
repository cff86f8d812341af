/// \file  Reading of integrators.
#include "renderer/io/load_integrator.h"

#include "renderer/io/load_properties.h"

#include <fmt/format.h>
#include <limits>

namespace plumb {
namespace {

constexpr std::int64_t largest = std::numeric_limits<std::int32_t>::max();

void load_depths(Properties& p, PathSettings& path) {
    path.max_depth = static_cast<int>(p.integer("max_depth", -1, -1, largest));
    if (path.max_depth == 0)
        p.refuse("max_depth", "-1 (no limit) or at least 1");
    path.rr_depth = static_cast<int>(p.integer("rr_depth", 5, 1, largest));
}

void load_moment(LoadContext& context, const XmlNode& integrator) {
    Properties p(context, integrator);
    const std::vector<const XmlNode*> nested = p.objects("integrator");
    if (nested.size() != 1 || nested.front() == &integrator)
        integrator.refuse(fmt::format("integrator 'moment' with {} nested integrators (expected 1)",
                                      nested.size()));
    if (nested.front()->value_or_empty("type") == "moment")
        nested.front()->refuse("integrator 'moment' inside another");
    p.finish();
    context.ignore(integrator, "integrator 'moment': only the integrator inside it is used");
    load_integrator(context, *nested.front());
}

} // namespace

void load_integrator(LoadContext& context, const XmlNode& integrator) {
    const std::string_view plugin =
        context.plugin(integrator, {"path", "direct", "moment"}, "taken as path");
    if (plugin == "moment") {
        load_moment(context, integrator);
        return;
    }
    Properties p(context, integrator);
    PathSettings& path = context.scene.path;
    if (plugin == "direct") {
        path.max_depth = 2;
        context.ignore(integrator, "integrator 'direct' is taken as path with max_depth 2");
        p.changes_no_pixel({"shading_samples", "emitter_samples", "bsdf_samples"});
    } else {
        load_depths(p, path);
    }
    path.hide_emitters = p.boolean("hide_emitters", false);
    if (!p.boolean("strict_normals", true))
        context.ignore(integrator,
                       "strict_normals false: normals are always strict, no light leaks");
    p.changes_no_pixel({"block_size", "samples_per_pass", "timeout"});
    if (plugin.empty())
        p.ignore_rest();
    p.finish();
}

} // namespace plumb
