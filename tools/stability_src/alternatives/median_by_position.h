/// \file  The depth of a tree that is split in the middle of space: an oracle of failure, for
/// tools/stability and its tests only.
#pragma once

#include "accel/math/bounds.h"

#include <algorithm>
#include <span>
#include <vector>

namespace plumb::stability {

/// Splits primitives, given by their centroids, at the middle of the centroids' box along its
/// longest axis until a node holds one or all are in one place. Returns the depth of the deepest
/// leaf, the root being 0. The order of the centroids is changed.
inline int depth_by_position(std::span<Vec3> centroids) {
    struct Entry {
        std::span<Vec3> range;
        int depth;
    };
    std::vector<Entry> stack{{centroids, 0}};
    int deepest = 0;
    while (!stack.empty()) {
        const Entry entry = stack.back();
        stack.pop_back();
        deepest = std::max(deepest, entry.depth);
        Bounds box;
        for (const Vec3& c : entry.range)
            box.extend(c);
        const Vec3 extent = box.extent();
        const int axis =
            extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
        const float middle = box.center()[axis];
        const auto split = std::partition(entry.range.begin(), entry.range.end(),
                                          [&](const Vec3& c) { return c[axis] < middle; });
        const auto left = static_cast<std::size_t>(split - entry.range.begin());
        if (left == 0 || left == entry.range.size())
            continue;
        stack.push_back({entry.range.subspan(0, left), entry.depth + 1});
        stack.push_back({entry.range.subspan(left), entry.depth + 1});
    }
    return deepest;
}

} // namespace plumb::stability
