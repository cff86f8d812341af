/// \file  The box test of the 8-wide tree in SSE2.
#include "accel/sah/isa/lanes_sse2.h"
#include "tools/stability_src/wide_box.h"
#include "tools/stability_src/wide_box_lanes.h"

namespace plumb::stability {

bool wide_box_portable(const Ray& ray, const Bounds& box) { return enters_all_lanes(ray, box); }

} // namespace plumb::stability
