#include "tools/bench_src/noise.h"

namespace plumb::bench {
namespace {

/// lowbias32 of C. Wellons, 2018.
std::uint32_t mixed(std::uint32_t x) {
    x = (x ^ (x >> 16u)) * 0x7feb352du;
    x = (x ^ (x >> 15u)) * 0x846ca68bu;
    return x ^ (x >> 16u);
}

/// Dot product of `offset` with the gradient of a lattice point, one of the 12 edges of a cube.
float slope(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed, Vec3 offset) {
    const std::uint32_t h =
        mixed(static_cast<std::uint32_t>(x) +
              mixed(static_cast<std::uint32_t>(y) + mixed(static_cast<std::uint32_t>(z) + seed))) &
        15u;
    const float u = h < 8 ? offset.x : offset.y;
    const float v = h < 4 ? offset.y : h == 12 || h == 14 ? offset.x : offset.z;
    return ((h & 1u) != 0 ? -u : u) + ((h & 2u) != 0 ? -v : v);
}

float fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }
float mix(float a, float b, float t) { return a + t * (b - a); }

} // namespace

float gradient_noise(Vec3 p, std::uint32_t seed) {
    const Vec3 cell{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    const Vec3 f = p - cell;
    const auto x = static_cast<std::int32_t>(cell.x), y = static_cast<std::int32_t>(cell.y),
               z = static_cast<std::int32_t>(cell.z);
    const auto along_x = [&](std::int32_t dy, std::int32_t dz) {
        const Vec3 o{f.x, f.y - static_cast<float>(dy), f.z - static_cast<float>(dz)};
        return mix(slope(x, y + dy, z + dz, seed, o),
                   slope(x + 1, y + dy, z + dz, seed, o - Vec3{1, 0, 0}), fade(f.x));
    };
    return mix(mix(along_x(0, 0), along_x(1, 0), fade(f.y)),
               mix(along_x(0, 1), along_x(1, 1), fade(f.y)), fade(f.z));
}

float fractal_noise(Vec3 p, int octaves, float gain, std::uint32_t seed) {
    float sum = 0, strength = 1;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += strength * gradient_noise(p, seed + static_cast<std::uint32_t>(octave));
        p = p * 2;
        strength *= gain;
    }
    return sum;
}

} // namespace plumb::bench
