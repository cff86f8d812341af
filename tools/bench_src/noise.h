/// \file  Gradient noise (K. Perlin, "Improving Noise", SIGGRAPH 2002) over hashed lattice points.
#pragma once

#include "accel/math/vec.h"

namespace plumb::bench {

/// Smooth noise, about -1 to 1, zero at lattice points; features one unit wide.
[[nodiscard]] float gradient_noise(Vec3 p, std::uint32_t seed);

/// `octaves` of it: each twice as fine and `gain` times as strong as the one before.
[[nodiscard]] float fractal_noise(Vec3 p, int octaves, float gain, std::uint32_t seed);

} // namespace plumb::bench
