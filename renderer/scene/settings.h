/// \file  How a scene wants to be rendered: what the command line can override.
#pragma once

#include "renderer/scene/filter.h"

#include <cstdint>

namespace plumb {

/// Part of the film that is rendered, in pixels.
struct Crop {
    int x = 0, y = 0, width = 0, height = 0;
};

struct FilmSettings {
    int width = 768, height = 576;
    Crop crop{0, 0, 768, 576}; ///< the whole film unless the scene says otherwise
    Filter filter;
};

enum class SamplerKind : std::uint8_t { sobol, independent };

struct SamplerSettings {
    SamplerKind kind = SamplerKind::sobol;
    std::uint32_t spp = 16; ///< samples per pixel, at least 1
    std::uint64_t seed = 0;
};

enum class Estimator : std::uint8_t { mis, light, bsdf };
enum class HemisphereSampling : std::uint8_t { cosine, uniform };
enum class LightSampling : std::uint8_t { solid_angle, area };
enum class RouletteKind : std::uint8_t { throughput, constant, none };

struct PathSettings {
    /// Longest path in segments: 1 sees emitters only, 2 adds direct light; negative: no limit.
    int max_depth = -1;
    /// First depth (in segments, the camera's being 1) after which roulette may end a path.
    int rr_depth = 5;
    bool hide_emitters = false; ///< directly visible emitters are black
    Estimator estimator = Estimator::mis;
    HemisphereSampling hemisphere = HemisphereSampling::cosine;
    LightSampling light_sampling = LightSampling::solid_angle;
    RouletteKind roulette = RouletteKind::throughput;
    float roulette_constant = 0.5f; ///< probability to go on, RouletteKind::constant only
    /// Side, in pixels, of the blocks that share paths from their second vertices on: 1 (none), 2
    /// or 4. Blocks are counted from the crop's corner. On the CPU, in streams only.
    int reuse = 1;
};

} // namespace plumb
