/// \file  The boxes of the two parts of a triangle that an axis-aligned plane cuts.
///
/// A ray that hits the triangle must meet the box of a part: at a point of the triangle, moved by
/// what the watertight test can be wrong by. So a part is padded like the triangle itself
/// (triangle_bounds: 8 u of the whole triangle's extent and 2 u of the coordinate) and for the
/// rounding of the cut besides (5 u of the extent, u of the coordinate); and it needs no more than
/// the triangle's own box, into which every hit is moved.
#pragma once

#include "accel/sah/primitive_ref.h"

namespace plumb {

class ClipTriangle {
  public:
    ClipTriangle(const TriangleVertices& t, Float4 area_scale);

    /// False for slivers and triangles without area, whose hits can be far along from where the
    /// ray passes: they stay whole.
    [[nodiscard]] bool can_be_cut() const { return can_be_cut_; }

    /// The parts within `box` below and above the plane; an empty one is Box{}. `box` is the
    /// triangle's own or a part of an earlier cut.
    void cut(int axis, float plane, const Box& box, Box& below, Box& above) const;

  private:
    [[nodiscard]] Box padded(Box part, const Box& within) const;

    Float4 vertex_[3];
    Float4 coordinate_[3]; ///< of the three vertices along each axis
    Float4 margin_;
    bool can_be_cut_;
};

} // namespace plumb
