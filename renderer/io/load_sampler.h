/// \file  <sampler> elements.
#pragma once

#include "renderer/io/load_context.h"

namespace plumb {

/// Reads a sampler into Scene::sampler: `independent` as such, every stratified or low-discrepancy
/// one as Sobol (reported unless it is `sobol`). Throws SceneError.
void load_sampler(LoadContext& context, const XmlNode& sampler);

} // namespace plumb
