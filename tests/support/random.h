/// \file  A small deterministic generator for tests: the same numbers on every machine.
///
/// PCG32 (XSH-RR): M. O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good
/// Algorithms for Random Number Generation", HMC-CS-2014-0905.
#pragma once

#include "accel/math/vec.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace plumb::test {

class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(0) {
        bits();
        state_ += seed;
        bits();
    }

    /// 32 uniform bits.
    std::uint32_t bits() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ull + 1442695040888963407ull;
        const auto mixed = static_cast<std::uint32_t>(((old >> 18u) ^ old) >> 27u);
        return std::rotr(mixed, static_cast<int>(old >> 59u));
    }
    /// Uniform in [0, 1), 24 bits.
    float uniform() { return static_cast<float>(bits() >> 8u) * 0x1p-24f; }
    /// Uniform in [low, high).
    float uniform(float low, float high) { return low + (high - low) * uniform(); }
    /// Uniform in [0, 1), 53 bits.
    double uniform_double() {
        const std::uint64_t high = bits();
        return static_cast<double>(((high << 32u) | bits()) >> 11u) * 0x1p-53;
    }
    /// Uniform in 0 .. count-1; count > 0.
    std::uint32_t index(std::uint32_t count) {
        return static_cast<std::uint32_t>((std::uint64_t{bits()} * count) >> 32u);
    }
    Vec2 square() {
        const float x = uniform();
        return {x, uniform()};
    }
    /// Uniform in [low, high)^3.
    Vec3 point(float low, float high) {
        const float x = uniform(low, high), y = uniform(low, high);
        return {x, y, uniform(low, high)};
    }
    /// Unit vector, uniform over the sphere, rounded from double.
    Vec3 direction() {
        const double z = 1 - 2 * uniform_double();
        const double phi = 2 * 3.14159265358979323846 * uniform_double();
        const double r = std::sqrt(1 - z * z);
        return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                static_cast<float>(z)};
    }

  private:
    std::uint64_t state_;
};

} // namespace plumb::test
