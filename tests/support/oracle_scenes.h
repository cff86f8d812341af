/// \file  Scenes whose radiance is known exactly, as text of scene files.
#pragma once

#include "tests/support/oracle.h"

namespace plumb::test {

/// Furnaces, cavities, a point light in a sphere: paths of any length.
[[nodiscard]] std::vector<Oracle> enclosed_oracles();
/// One bounce from the sky or from round lights.
[[nodiscard]] std::vector<Oracle> sky_oracles();
[[nodiscard]] std::vector<Oracle> round_light_oracles();
/// One bounce from polygons: at a point, or the mean over a square (form factors).
[[nodiscard]] std::vector<Oracle> polygon_oracles();

} // namespace plumb::test
