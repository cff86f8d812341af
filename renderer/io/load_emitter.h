/// \file  <emitter> elements.
#pragma once

#include "renderer/io/load_context.h"

namespace plumb {

/// Reads an emitter that belongs to no shape: `point` or `constant`. False if it was left out
/// (lenient). Throws SceneError.
bool load_emitter(LoadContext& context, const XmlNode& emitter);

/// The radiance of an `area` emitter inside a shape; black if left out (lenient).
[[nodiscard]] Rgb load_area_emitter(LoadContext& context, const XmlNode& emitter);

} // namespace plumb
