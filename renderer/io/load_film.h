/// \file  <film> elements and their <rfilter>.
#pragma once

#include "renderer/io/load_context.h"

namespace plumb {

inline constexpr int max_film_side = 65536; ///< pixels

/// Reads `hdrfilm` or `ldrfilm` into Scene::film. Throws SceneError.
void load_film(LoadContext& context, const XmlNode& film);

} // namespace plumb
