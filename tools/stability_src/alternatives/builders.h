/// \file  What builders of trees must not do: oracles of failure, for the tests only.
#pragma once

#include "accel/math/bounds.h"

#include <algorithm>
#include <span>

namespace plumb::stability {

/// Surface area in float: infinite from coordinates of 1e19 on, so that all splits cost the same.
inline float area_in_float(const Bounds& b) {
    const Vec3 e = b.extent();
    return 2 * (e.x * e.y + e.y * e.z + e.z * e.x);
}

/// Primitives in the largest leaf of a builder that makes a leaf where its binning by centroids
/// finds no plane between two of them: with identical centroids all of them. Splits in the middle
/// of the bins elsewhere.
inline std::size_t largest_leaf_without_fallback(std::span<Vec3> centroids, std::size_t leaf_size) {
    if (centroids.size() <= leaf_size)
        return centroids.size();
    Bounds box;
    for (const Vec3& c : centroids)
        box.extend(c);
    const Vec3 extent = box.extent();
    const int axis =
        extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
    const float middle = box.center()[axis];
    const auto split = std::partition(centroids.begin(), centroids.end(),
                                      [&](const Vec3& c) { return c[axis] < middle; });
    const auto left = static_cast<std::size_t>(split - centroids.begin());
    if (left == 0 || left == centroids.size())
        return centroids.size();
    return std::max(largest_leaf_without_fallback(centroids.subspan(0, left), leaf_size),
                    largest_leaf_without_fallback(centroids.subspan(left), leaf_size));
}

/// Whether a triangle's bin and the plane between two bins put a vertex at x on different sides:
/// counts are made with the one and references are divided with the other.
inline bool bin_and_plane_disagree(float lower, float upper, int bins, int plane, float x) {
    const float width = (upper - lower) / static_cast<float>(bins);
    const int bin = std::min(static_cast<int>((x - lower) * (1 / width)), bins - 1);
    return (bin < plane) != (x < lower + width * static_cast<float>(plane));
}

} // namespace plumb::stability
