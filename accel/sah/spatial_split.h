/// \file  The best plane that cuts space, and the triangles it goes through.
///
/// M. Stich, H. Friedrich, A. Dietrich, "Spatial Splits in Bounding Volume Hierarchies", High
/// Performance Graphics 2009.
#pragma once

#include "accel/sah/clip_triangle.h"
#include "accel/sah/sah_cost.h"

#include <optional>

namespace plumb {

inline constexpr int max_spatial_bins = 32;

/// From the first to the last bin that a box reaches into, on each axis.
struct BinSpans {
    std::int32_t first[4], last[4];
};

/// Equal slabs of a box along each axis. The one classifier for choosing a plane and for cutting
/// at it, so that the two cannot disagree.
class SpatialBins {
  public:
    SpatialBins(const Box& bounds, int count);
    [[nodiscard]] int count() const { return count_; }
    /// False where the slabs have no thickness: all is in bin 0.
    [[nodiscard]] bool usable(int axis) const { return width_[axis] > 0; }
    /// Lower end of a bin, within rounding.
    [[nodiscard]] float plane(int axis, int bin) const {
        return lower_[axis] + width_[axis] * static_cast<float>(bin);
    }
    /// Of a box inside the one that is divided.
    [[nodiscard]] BinSpans spans(const Box& box) const;
    /// The bins of the centre of a primitive which cannot be cut.
    [[nodiscard]] BinSpans whole(const Box& box) const;

  private:
    [[nodiscard]] Float4 position(Float4 point) const;

    Float4 origin_, scale_;
    float lower_[3], width_[3];
    int count_;
};

struct SpatialSplit {
    SpatialBins bins;
    int axis, first_right_bin;
    std::size_t left_count, right_count; ///< at most
    Box left, right;
    float left_area, right_area; ///< half areas, scaled
    float cost;                  ///< as BinnedSplit
};

/// Finds and carries out spatial splits.
class SpatialSplitter {
  public:
    SpatialSplitter(const GeometryView& geometry, const PrimitiveNumbers& numbers,
                    Float4 area_scale, const Workers& workers)
        : geometry_(geometry), numbers_(numbers), area_scale_(area_scale), workers_(workers) {}

    /// The cheapest split that costs less than `limit`, leaves fewer primitives than there are on
    /// each side and makes at most `room` more references; nothing where no axis has one.
    [[nodiscard]] std::optional<SpatialSplit> best(const PrimitiveRange& range, std::size_t room,
                                                   float limit) const;

    /// Cuts the triangles that cross the plane, or puts them whole on one side where that costs
    /// less; new references are written behind the range. Orders all and measures both sides.
    /// False where a side would be empty: nothing was changed then but the order.
    bool apply(const PrimitiveRange& range, const SpatialSplit& split, PrimitiveRange& left,
               PrimitiveRange& right) const;

  private:
    struct Counts;
    struct Cut;
    enum Side : std::uint8_t { goes_left, goes_right, goes_both };

    /// Every `stride`-th reference, as if it were so many.
    void bin(std::span<const PrimitiveRef> refs, std::uint32_t stride, const SpatialBins& bins,
             Counts& counts) const;
    /// What a split has to be like; `best` is the cheapest so far.
    struct Search {
        std::size_t count, room;
        float limit;
        std::optional<SpatialSplit> best;
    };
    void sweep(const Counts& counts, int axis, const SpatialBins& bins, Search& search) const;
    /// Counts, boxes and cost as they are, for a split that was found with a sample.
    void measure(std::span<const PrimitiveRef> refs, SpatialSplit& split) const;
    [[nodiscard]] Cut cut(const PrimitiveRef& ref, const SpatialSplit& split) const;
    /// Of a triangle that crosses the plane: maybe one side for the whole costs less than two.
    [[nodiscard]] Side cheapest_side(const Box& whole, const SpatialSplit& split) const;
    /// Nothing for what must not be cut.
    [[nodiscard]] std::optional<ClipTriangle> triangle(PrimitiveNumber number) const;

    const GeometryView& geometry_;
    const PrimitiveNumbers& numbers_;
    Float4 area_scale_;
    const Workers& workers_;
};

} // namespace plumb
