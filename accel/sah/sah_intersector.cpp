#include "accel/sah/sah_intersector.h"

#include "accel/sah/build_binary.h"
#include "accel/sah/collapse.h"

#include <chrono>

namespace plumb {

SahIntersector::SahIntersector(const GeometryView& geometry, const BuildOptions& options)
    : kernels_(kernels_for(usable_isa(options.isa), options.triangle_test)) {
    const auto start = std::chrono::steady_clock::now();
    const BinaryBvh binary = build_binary(geometry, {options.quality, options.threads});
    tree_ = collapse(binary, geometry, options.threads);
    view_ = tree_.view();
    stats_.build_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    stats_.bytes = tree_.memory.bytes();
    stats_.node_count = tree_.node_count + tree_.leaf_count;
    stats_.leaf_count = tree_.leaf_count;
    stats_.primitive_count = binary.primitive_count;
    stats_.skipped_count = binary.skipped_count;
    stats_.depth = tree_.depth;
    stats_.sah_cost = tree_.sah_cost;
}

} // namespace plumb
