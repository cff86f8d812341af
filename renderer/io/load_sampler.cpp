/// \file  Reading of samplers.
#include "renderer/io/load_sampler.h"

#include "renderer/io/load_properties.h"

#include <fmt/format.h>
#include <limits>

namespace plumb {

void load_sampler(LoadContext& context, const XmlNode& sampler) {
    const std::string_view plugin =
        context.plugin(sampler,
                       {"independent", "sobol", "ldsampler", "halton", "hammersley", "stratified",
                        "multijitter", "orthogonal"},
                       "taken as sobol");
    SamplerSettings& settings = context.scene.sampler;
    settings.kind = plugin == "independent" ? SamplerKind::independent : SamplerKind::sobol;
    if (plugin != "independent" && plugin != "sobol")
        context.ignore(sampler, fmt::format("sampler '{}' is taken as sobol", plugin));
    Properties p(context, sampler);
    // Mitsuba's default where the file says nothing.
    settings.spp = static_cast<std::uint32_t>(
        p.integer("sample_count", 4, 1, std::numeric_limits<std::int32_t>::max()));
    settings.seed = static_cast<std::uint64_t>(
        p.integer("seed", 0, 0, std::numeric_limits<std::int64_t>::max()));
    p.changes_no_pixel({"scramble", "dimension", "jitter", "strength"});
    p.finish();
}

} // namespace plumb
