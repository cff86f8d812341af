/// \file  Deterministic random numbers of the generated meshes and rays.
#pragma once

#include "accel/math/vec.h"

#include <random>

namespace plumb::bench {

/// The same numbers on every machine: the standard fixes the engine, not its distributions.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    /// Uniform in [0, 1), 24 bits.
    float uniform() { return static_cast<float>(engine_() >> 40u) * 0x1p-24f; }
    /// Uniform in [low, high).
    float uniform(float low, float high) { return low + (high - low) * uniform(); }
    Vec2 square() {
        const float x = uniform();
        return {x, uniform()};
    }
    /// Uniform in the box.
    Vec3 point(Vec3 low, Vec3 high) {
        const float x = uniform(low.x, high.x), y = uniform(low.y, high.y);
        return {x, y, uniform(low.z, high.z)};
    }
    /// Uniform in 0 .. count-1; count > 0.
    std::size_t index(std::size_t count) { return engine_() % count; }

  private:
    std::mt19937_64 engine_;
};

} // namespace plumb::bench
