/// \file  Checks the invariants of a naive BVH; for tests.
#pragma once

#include "accel/naive/build_naive.h"

#include <string>

namespace plumb {

/// Every traceable primitive in exactly one leaf, every box containing what is below it, every
/// node reached once, depth at most ceil(log2 n). Returns what is wrong first, or nothing.
[[nodiscard]] std::string check_tree(const NaiveTree& tree, const GeometryView& geometry);

} // namespace plumb
