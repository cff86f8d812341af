/// \file  The box test of the 8-wide tree with AVX2 and FMA3, where the build has them.
#include "tools/stability_src/wide_box.h"

#if defined(__AVX2__) && defined(__FMA__)
#include "accel/sah/isa/lanes_avx.h"
#include "tools/stability_src/wide_box_lanes.h"

namespace plumb::stability {

BoxTest wide_box_fused() { return enters_all_lanes; }

} // namespace plumb::stability
#else
namespace plumb::stability {

BoxTest wide_box_fused() { return nullptr; }

} // namespace plumb::stability
#endif
