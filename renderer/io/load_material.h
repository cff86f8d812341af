/// \file  <bsdf> elements.
#pragma once

#include "renderer/io/load_context.h"

#include <array>
#include <map>
#include <set>
#include <unordered_map>

namespace plumb {

/// Ids of the materials of both sides of a surface; invalid_id: absorbs.
struct MaterialSides {
    std::uint32_t front = invalid_id, back = invalid_id;
};

/// Turns BSDF elements into Scene::materials. Equal materials are one.
class MaterialLoader {
  public:
    explicit MaterialLoader(LoadContext& context) : context_(context) {}

    /// `diffuse`: the front only. `twosided`: its one BSDF on both sides, or its two, front first.
    /// An element read before gives the same ids. Throws SceneError.
    [[nodiscard]] MaterialSides sides(const XmlNode& bsdf);
    [[nodiscard]] std::uint32_t diffuse(Rgb reflectance);

  private:
    MaterialSides load(const XmlNode& bsdf);
    MaterialSides load_twosided(const XmlNode& bsdf);

    LoadContext& context_;
    std::unordered_map<const XmlNode*, MaterialSides> loaded_;
    std::set<const XmlNode*> in_progress_; ///< to see a BSDF that contains itself
    std::map<std::array<float, 3>, std::uint32_t> diffuse_;
};

} // namespace plumb
