/// \file  <sensor> elements with their film, filter and sampler.
#pragma once

#include "renderer/io/load_context.h"

namespace plumb {

/// Reads a `perspective` sensor into Scene::camera, film and sampler. Throws SceneError.
void load_sensor(LoadContext& context, const XmlNode& sensor);

} // namespace plumb
