/// \file  Builds the binary SAH tree that all layouts are made from.
#pragma once

#include "accel/intersector.h"
#include "accel/sah/binary_bvh.h"

namespace plumb {

struct BinaryBuildOptions {
    BuildQuality quality = BuildQuality::medium;
    int threads = 0; ///< 0: all cores. The tree is the same for any number
    /// high: how many more references than primitives spatial splits may make, as a part of the
    /// primitives.
    float duplication = 0.3f;
};

/// fast and medium are the same tree: binned SAH over 32 bins, every split position in ranges of up
/// to 64 primitives, each primitive once. high cuts large triangles (spatial splits) and moves
/// subtrees afterwards (reinsertion).
///
/// SAH tree over all traceable primitives; no leaf lies deeper than sah_max_depth. Deterministic.
/// Throws std::bad_alloc where memory ends and std::runtime_error above 2^31 primitives.
[[nodiscard]] BinaryBvh build_binary(const GeometryView& geometry,
                                     const BinaryBuildOptions& options = {});

} // namespace plumb
