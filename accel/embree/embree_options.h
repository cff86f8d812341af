/// \file  How Embree is asked to build and trace.
#pragma once

#include "accel/intersector.h"

namespace plumb {

/// A configuration of Embree. The defaults are what the renderer's --accel=embree uses.
struct EmbreeOptions {
    bool robust = true; ///< RTC_SCENE_FLAG_ROBUST: edges do not leak; slower
    BuildQuality quality = BuildQuality::medium; ///< low, medium and high
    int packet = 1;  ///< width of queries for spans of rays: 1, or 16 (the coherent flag is set)
    int threads = 0; ///< of the build; 0: all cores
};

} // namespace plumb
