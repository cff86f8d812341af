/// \file  Reconstruction filters of the film.
#pragma once

#include <cstdint>
#include <string_view>

namespace plumb {

enum class FilterKind : std::uint8_t { box, tent, gaussian, mitchell };

/// Separable filters, in pixels. Box: half width 0.5. Tent: half width `radius` (default 1).
/// Gaussian: standard deviation `stddev`, cut at 4 of them. Mitchell-Netravali: half width 2 with
/// B and C (Mitchell & Netravali 1988).
struct Filter {
    FilterKind kind = FilterKind::gaussian;
    float radius = 1;
    float stddev = 0.5f;
    float b = 1.0f / 3, c = 1.0f / 3;
};

} // namespace plumb
