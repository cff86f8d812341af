/// \file  The kernels for AVX2 and FMA3; compiled with -march=x86-64-v3.
#ifdef __x86_64__
#include "accel/sah/isa/lanes_avx.h"
#include "accel/sah/isa/packet_lanes_avx2.h"
#include "accel/sah/isa/make_kernels.h"

namespace plumb {

WideKernels avx2_kernels(TriangleTest test) { return make_kernels<Lanes, PacketLanes>(test); }

} // namespace plumb
#endif
