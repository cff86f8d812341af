/// \file  The box test of the 8-wide tree for one ray and one box, an instruction set a file.
#pragma once

#include "accel/math/bounds.h"

namespace plumb::stability {

/// Whether the ray, which must be valid, enters the box.
[[nodiscard]] bool wide_box_portable(const Ray& ray, const Bounds& box); ///< SSE2
/// With fused multiply-add; null where this build has none.
using BoxTest = bool (*)(const Ray& ray, const Bounds& box);
[[nodiscard]] BoxTest wide_box_fused();

} // namespace plumb::stability
