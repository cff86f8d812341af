/// \file  Random numbers of the trials: directions, doubles, powers of ten.
#pragma once

#include "tools/bench_src/random.h"

#include <cmath>
#include <vector>

namespace plumb::stability {

using bench::Random;

inline constexpr double pi_double = 3.14159265358979323846;

/// Uniform in [0, 1), 53 bits.
inline double uniform_double(Random& random) {
    return static_cast<double>(random.index(std::size_t{1} << 53u)) * 0x1p-53;
}

/// Uniform in [low, high)^3.
inline Vec3 cube_point(Random& random, float low, float high) {
    return random.point({low, low, low}, {high, high, high});
}

/// Unit vector, uniform over the sphere, rounded from double.
inline Vec3 direction(Random& random) {
    const double z = 1 - 2 * uniform_double(random);
    const double phi = 2 * pi_double * uniform_double(random);
    const double r = std::sqrt(1 - z * z);
    return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
            static_cast<float>(z)};
}

/// 10^low, 10^(low + 1), ..., 10^high.
inline std::vector<double> powers_of_ten(int low, int high) {
    std::vector<double> powers;
    for (int i = low; i <= high; ++i)
        powers.push_back(i < 0 ? 1 / std::pow(10.0, -i) : std::pow(10.0, i));
    return powers;
}

/// 0 and the powers of ten.
inline std::vector<double> zero_and_powers(int low, int high) {
    std::vector<double> powers{0.0};
    for (const double power : powers_of_ten(low, high))
        powers.push_back(power);
    return powers;
}

} // namespace plumb::stability
