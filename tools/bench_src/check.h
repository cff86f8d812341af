/// \file  Whether answers are the reference's.
#pragma once

#include "accel/math/ray.h"

#include <span>

namespace plumb::bench {

/// How many hits are not, bit for bit, those of the reference.
[[nodiscard]] std::uint64_t different_bits(std::span<const Hit> hits,
                                           std::span<const Hit> reference);

/// For another arithmetic: how many rays hit in one and miss in the other, or lie apart in t by
/// more than 8 ulp and more than 1e-5 of it.
[[nodiscard]] std::uint64_t far_apart(std::span<const Hit> hits, std::span<const Hit> reference);

} // namespace plumb::bench
