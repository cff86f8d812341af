/// \file  The order of children in the AVX2 and AVX-512 kernels; where this file is compiled for
/// them.
#ifdef __AVX2__
#include "accel/sah/isa/lanes_avx.h"
#include "tests/accel/child_order.h"

namespace plumb::test {
namespace {

TEST(ChildOrder, OfAvxLanesIsFarthestFirst) { expect_children_in_order<Lanes>(200); }

} // namespace
} // namespace plumb::test
#endif
