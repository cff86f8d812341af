/// \file  The kernels for AVX-512 with 256-bit vectors; compiled with -march=x86-64-v4.
#ifdef __x86_64__
#include "accel/sah/isa/lanes_avx.h"
#include "accel/sah/isa/packet_lanes_avx512.h"
#include "accel/sah/isa/make_kernels.h"

namespace plumb {

WideKernels avx512_kernels(TriangleTest test) { return make_kernels<Lanes, PacketLanes>(test); }

} // namespace plumb
#endif
