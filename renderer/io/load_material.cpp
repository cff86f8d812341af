/// \file  Reading of BSDFs.
#include "renderer/io/load_material.h"

#include "renderer/io/load_properties.h"

#include <fmt/format.h>

namespace plumb {

MaterialSides MaterialLoader::sides(const XmlNode& bsdf) {
    const auto found = loaded_.find(&bsdf);
    if (found != loaded_.end())
        return found->second;
    if (!in_progress_.insert(&bsdf).second)
        bsdf.refuse(
            fmt::format("reference cycle (bsdf '{}' contains itself)", bsdf.value_or_empty("id")));
    const MaterialSides result = load(bsdf);
    in_progress_.erase(&bsdf);
    loaded_.emplace(&bsdf, result);
    return result;
}

MaterialSides MaterialLoader::load(const XmlNode& bsdf) {
    const std::string_view plugin =
        context_.plugin(bsdf, {"diffuse", "twosided"}, "taken as diffuse 0.5 on both sides");
    if (plugin.empty()) {
        const std::uint32_t grey = diffuse({0.5f, 0.5f, 0.5f});
        return {grey, grey};
    }
    if (plugin == "twosided")
        return load_twosided(bsdf);
    Properties p(context_, bsdf);
    const char* name = p.has("diffuse_reflectance") ? "diffuse_reflectance" : "reflectance";
    const Rgb reflectance = p.colour(name, {0.5f, 0.5f, 0.5f}, 0, 1);
    p.finish();
    return {diffuse(reflectance), invalid_id};
}

MaterialSides MaterialLoader::load_twosided(const XmlNode& bsdf) {
    Properties p(context_, bsdf);
    const std::vector<const XmlNode*> nested = p.objects("bsdf");
    if (nested.empty() || nested.size() > 2)
        bsdf.refuse(
            fmt::format("bsdf 'twosided' with {} nested bsdfs (expected 1 or 2)", nested.size()));
    const MaterialSides front = sides(*nested.front());
    const MaterialSides back = nested.size() == 2 ? sides(*nested.back()) : front;
    p.finish();
    return {front.front, back.front};
}

std::uint32_t MaterialLoader::diffuse(Rgb reflectance) {
    auto& materials = context_.scene.materials;
    const auto next = static_cast<std::uint32_t>(materials.size());
    const auto [place, added] =
        diffuse_.emplace(std::array{reflectance.r, reflectance.g, reflectance.b}, next);
    if (added)
        materials.push_back({MaterialKind::diffuse, reflectance});
    return place->second;
}

} // namespace plumb
