/// \file  <integrator> elements.
#pragma once

#include "renderer/io/load_context.h"

namespace plumb {

/// Reads `path`, and `direct` as a path of two segments, into Scene::path; takes the integrator
/// inside `moment`. Throws SceneError.
void load_integrator(LoadContext& context, const XmlNode& integrator);

} // namespace plumb
