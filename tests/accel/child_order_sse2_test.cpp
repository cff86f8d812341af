/// \file  The order of children in the portable kernels.
#ifdef __x86_64__
#include "accel/sah/isa/lanes_sse2.h"
#include "tests/accel/child_order.h"

namespace plumb::test {
namespace {

TEST(ChildOrder, OfPortableLanesIsFarthestFirst) { expect_children_in_order<Lanes>(200); }

} // namespace
} // namespace plumb::test
#endif
