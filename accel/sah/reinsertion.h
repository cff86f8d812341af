/// \file  Makes a finished tree cheaper by moving subtrees to where they enlarge fewer boxes.
///
/// D. Meister, J. Bittner, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization",
/// Computer Graphics Forum 37(2), 2018.
#pragma once

#include "accel/parallel/parallel.h"
#include "accel/sah/binary_bvh.h"

namespace plumb {

struct ReinsertionOptions {
    int passes = 3;
    float fraction = 0.5f; ///< of the nodes, those with the largest boxes, are tried in each pass
};

/// Moves subtrees, never a primitive between leaves; joins neighbouring leaves where that is
/// cheaper; orders the nodes depth-first. The tree stays as it was where it would become no cheaper
/// or deeper than sah_max_depth. The same for any number of threads.
void optimize_by_reinsertion(BinaryBvh& tree, const ReinsertionOptions& options,
                             PrimitiveNumber first_sphere, const Workers& workers);

} // namespace plumb
