/// \file  What many paths carry, an array a number: loops over them become vector instructions.
#pragma once

#include "renderer/integrate/path_steps.h"

#include <cstddef>
#include <cstdint>

namespace plumb {

/// Paths that are traced together. More make longer streams of rays; fewer stay in the cache.
inline constexpr std::size_t max_lanes = 512;

/// A number of each path. A line of the cache longer than it has to be: else the same lane of four
/// arrays in a row, and so of dozens, would compete for one set of the first-level cache.
template <class T> struct alignas(64) Lanes {
    T lane[max_lanes + 64 / sizeof(T)];

    T& operator[](std::size_t i) { return lane[i]; }
    const T& operator[](std::size_t i) const { return lane[i]; }
};

/// Values of three floats: Vec3 or Rgb.
template <class Triple> struct TripleLanes {
    Lanes<float> a, b, c;

    [[nodiscard]] Triple operator[](std::size_t i) const { return {a[i], b[i], c[i]}; }
    void set(std::size_t i, const Triple& value) {
        const auto [x, y, z] = value;
        a[i] = x;
        b[i] = y;
        c[i] = z;
    }
};
using Vec3Lanes = TripleLanes<Vec3>;
using RgbLanes = TripleLanes<Rgb>;

/// Four numbers of the sampler each.
struct SampleLanes {
    Lanes<float> x[4];
};

/// Flags are words: as wide as what they are computed from.
using FlagLanes = Lanes<std::uint32_t>;

/// All that is kept of the paths between the steps. Zeroed when made; 320 kB.
struct PathLanes {
    // Of each path as it was added.
    Lanes<std::int32_t> pixel_x, pixel_y;
    Lanes<std::uint32_t> first_sample;
    Lanes<float> weight;
    RgbLanes radiance;

    // Of each path that lives, closed up: what it carries, and where it was added.
    Lanes<std::uint32_t> slot, pixel, sample, ray;
    RgbLanes throughput;
    Lanes<float> pdf;
    Vec3Lanes wo, from, from_normal;

    // The vertex that it is at.
    Vec3Lanes position, error, geometric, shading;
    FlagLanes front;
    Lanes<std::uint32_t> surface, primitive, material;
    RgbLanes reflectance;
    Vec3Lanes corner[3]; ///< of a flat triangle, and where it was hit
    Lanes<float> u, v;

    // Its random numbers: of light_group, and of direction_group.
    SampleLanes light_u, direction_u;

    // What comes of it.
    FlagLanes flag, exception;
    Vec3Lanes next_origin, next_direction;
    Lanes<float> next_tmax;
    RgbLanes light;

    // Rays and what they met. `source`: the lane that a ray belongs to.
    Lanes<Ray> rays;
    Lanes<Hit> hits;
    Lanes<std::uint32_t> source;
    Lanes<std::uint8_t> blocked;
};

} // namespace plumb
