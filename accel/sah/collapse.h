/// \file  From the binary tree to the 8-wide one.
///
/// Which nodes become children of one wide node, and which subtrees one leaf, is chosen by dynamic
/// programming over the surface area heuristic: H. Ylitie, T. Karras, S. Laine, "Efficient
/// Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017, section 3.
#pragma once

#include "accel/sah/wide_bvh.h"

namespace plumb {

/// On up to `threads` threads (0: all cores); the tree is the same for any number. Throws
/// std::bad_alloc, and std::runtime_error for a tree of more than 64 GB.
[[nodiscard]] WideBvh collapse(const BinaryBvh& binary, const GeometryView& geometry,
                               int threads = 0);

} // namespace plumb
