/// \file  The best of 32 planes on each axis by the surface area heuristic.
///
/// I. Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IEEE Symposium on
/// Interactive Ray Tracing 2007.
#pragma once

#include "accel/sah/primitive_ref.h"
#include "accel/sah/sah_cost.h"

#include <optional>

namespace plumb {

inline constexpr int bin_count = 32;

/// Puts centroids into bins. The one classifier for choosing a split and for carrying it out, so
/// that the two cannot disagree.
class BinClassifier {
  public:
    /// Axes along which the centroids are too close together to be told apart put all into bin 0.
    explicit BinClassifier(const Box& centroids);

    /// Position in bins on each axis: 0 <= x, and bin i takes i <= x < i + 1, the last bin the
    /// rest.
    [[nodiscard]] Float4 position(Float4 centroid) const {
        return float4::multiply(float4::subtract(centroid, origin_), scale_);
    }

  private:
    Float4 origin_, scale_;
};

/// Primitives whose position on `axis` is below `first_right_bin` go left.
struct BinnedSplit {
    BinClassifier classifier;
    int axis, first_right_bin;
    std::size_t left_count;
    Box left, right; ///< boxes of the two sides
    float cost;      ///< area times leaf_cost of both sides, half areas scaled by the builder

    /// 1 or 0.
    [[nodiscard]] unsigned goes_left(Float4 centroid) const {
        const Float4 plane = float4::broadcast(static_cast<float>(first_right_bin));
        return (float4::less(classifier.position(centroid), plane) >> axis) & 1u;
    }
};

/// Axes along which splits are looked for: `widest` is that of the centroids' box. It saves a tenth
/// to a sixth of a build; greedy as both are, the trees cost from 9 % less to 0.4 % more on the
/// benchmark's meshes.
enum class SplitAxes : std::uint8_t { all, widest };

/// The cheapest split with primitives on both sides; nothing where no axis has one. Areas are
/// multiplied by scale^2: it keeps them in the range of float whatever the scene's size.
[[nodiscard]] std::optional<BinnedSplit> best_binned_split(const PrimitiveRange& range,
                                                           SplitAxes axes, Float4 scale,
                                                           const Workers& workers);

/// Orders a range so that the left side comes first, and measures both sides.
void partition(const PrimitiveRange& range, const BinnedSplit& split, PrimitiveRange& left,
               PrimitiveRange& right, const Workers& workers);

} // namespace plumb
