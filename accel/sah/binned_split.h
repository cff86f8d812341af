/// \file  The best of 32 planes on each axis by the surface area heuristic.
///
/// I. Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IEEE Symposium on
/// Interactive Ray Tracing 2007.
#pragma once

#include "accel/geometry.h"

#include <optional>

namespace plumb {

/// Costs of the surface area heuristic, in units of one node visited. Leaves are tested as a block
/// of eight lanes: a block costs as such, and each triangle in it adds the chance that it passes
/// the filter.
inline constexpr double traversal_cost = 1;   ///< C_t: a node
inline constexpr double block_cost = 1;       ///< C_i: a block of up to eight primitives
inline constexpr double primitive_cost = 0.1; ///< each primitive of a block

inline constexpr int bin_count = 32;

/// A primitive while a tree is built.
struct PrimitiveRef {
    Bounds bounds;
    std::uint32_t geometry, primitive;

    /// Twice the centre of the box.
    [[nodiscard]] Vec3 centroid() const { return bounds.lower + bounds.upper; }
};

/// Primitives with the box around them and the box around their centroids.
struct PrimitiveRange {
    std::span<PrimitiveRef> refs;
    Bounds bounds, centroids;

    /// Measures the two boxes.
    explicit PrimitiveRange(std::span<PrimitiveRef> primitives);
};

/// Puts centroids into bins. The one classifier for choosing a split and for carrying it out, so
/// that the two cannot disagree.
class BinClassifier {
  public:
    BinClassifier(int axis, const Bounds& centroids);
    /// False where the centroids are too close together to be told apart.
    [[nodiscard]] bool usable() const;
    [[nodiscard]] int operator()(const PrimitiveRef& ref) const;

  private:
    int axis_;
    float origin_, scale_;
};

struct BinnedSplit {
    BinClassifier classify;
    int first_right_bin; ///< lower bins go left
    double cost;         ///< of the node and its two children, times the node's area
};

/// Cost of a leaf of `count` primitives, to be multiplied by its area.
[[nodiscard]] double leaf_cost(std::size_t count);

/// The cheapest split with primitives on both sides; nothing where no axis has one.
[[nodiscard]] std::optional<BinnedSplit> best_binned_split(const PrimitiveRange& range);

} // namespace plumb
