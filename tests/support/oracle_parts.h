/// \file  What the scenes of several oracles share.
#pragma once

#include "tests/support/oracle.h"
#include "tests/support/scene_text.h"

#include <cmath>

namespace plumb::test {

inline constexpr double pi_double = 3.14159265358979323846;
inline constexpr Double3 up_z{0, 0, 1};
/// Of walls that light meets many times: not 1/2, and another in each channel.
inline constexpr Double3 wall_albedo{0.6, 0.3, 0.45};
/// Of surfaces that light meets once: bright, so that roulette takes few of the paths.
inline constexpr Double3 receiver_albedo{0.9, 0.4, 0.6};
inline constexpr Double3 light_of_three{4, 2.5, 1.5};

/// Sees the origin only, from a side: every pixel is a sample of that point.
[[nodiscard]] inline std::string camera_on_origin() {
    return camera_at({-0.9, 0.35, 0.5}, {0, 0, 0}, up_z, 0.02);
}

/// A small square around the origin, facing +z.
[[nodiscard]] inline std::string receiver() {
    return rectangle({0, 0, 0}, {0.3, 0, 0}, {0, 0.3, 0}, diffuse(receiver_albedo));
}

/// A receiver of irradiance `per_radiance` x radiance: one bounce.
[[nodiscard]] inline Oracle one_bounce(std::string name, std::string xml, double per_radiance,
                                       const Double3& radiance = light_of_three) {
    Oracle oracle;
    oracle.name = std::move(name);
    oracle.xml = std::move(xml);
    for (std::size_t c = 0; c < 3; ++c)
        oracle.expected[c] = oracle.expected_cut[c] = oracle.expected_alone[c] =
            receiver_albedo[c] / pi_double * per_radiance * radiance[c];
    return oracle;
}

} // namespace plumb::test
