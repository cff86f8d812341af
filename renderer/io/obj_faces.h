/// \file  The faces of an OBJ file, with one vertex for each different position/uv/normal triple.
#pragma once

#include "accel/geometry.h"
#include "accel/math/ray.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace plumb {

/// Indices from 0 of a corner of a face; invalid_id: not given.
struct ObjCorner {
    std::uint32_t position = invalid_id, uv = invalid_id, normal = invalid_id;
    constexpr bool operator==(const ObjCorner&) const = default;
};

/// Splits polygons into triangles and numbers their corners so that equal ones share a vertex. As
/// long as uv and normal of every corner are absent or equal to its position (`f 1 2 3`,
/// `f 1/1/1 2/2/2 3/3/3`), the position is the number and no corner is stored: is_direct().
class ObjFaces {
  public:
    void reserve(std::size_t triangles) { triangles_.reserve(triangles); }
    /// Adds a fan around the first of at least 3 corners (right for convex polygons, as in
    /// Mitsuba). Triangles with a repeated position are counted and left out.
    void add(std::span<const ObjCorner> polygon);

    [[nodiscard]] std::vector<Triangle>& triangles() { return triangles_; }
    [[nodiscard]] std::size_t degenerate() const { return degenerate_; }
    [[nodiscard]] bool is_direct() const { return corners_.empty(); }
    /// Each vertex's corner, unless is_direct().
    [[nodiscard]] const std::vector<ObjCorner>& corners() const { return corners_; }

  private:
    [[nodiscard]] bool are_direct(std::span<const ObjCorner> polygon);
    void leave_direct();
    [[nodiscard]] std::uint32_t number_of(const ObjCorner& corner);
    void grow();

    std::vector<Triangle> triangles_;
    std::size_t degenerate_ = 0;
    bool any_seen_ = false, with_uv_ = false, with_normal_ = false; ///< form of direct corners
    std::vector<ObjCorner> corners_;
    std::vector<std::uint32_t> table_; ///< open addressing, a power of two; invalid_id: free
};

} // namespace plumb
