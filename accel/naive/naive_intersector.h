/// \file  The naive BVH as an Intersector: recursive, binary, one primitive a leaf.
///
/// It is the yardstick of the others: short enough to be read at one sitting.
#pragma once

#include "accel/intersector.h"
#include "accel/naive/build_naive.h"

namespace plumb {

/// Builds its tree in the constructor; see build_naive for what that throws.
class NaiveIntersector final : public Intersector {
  public:
    NaiveIntersector(GeometryView geometry, TriangleTest test);

    using Intersector::closest;
    using Intersector::occluded;
    [[nodiscard]] Hit closest(const Ray& ray) const override;
    [[nodiscard]] bool occluded(const Ray& ray) const override;
    [[nodiscard]] AccelStats stats() const override;

    [[nodiscard]] const NaiveTree& tree() const { return tree_; }
    [[nodiscard]] const GeometryView& geometry() const { return geometry_; }

  private:
    bool intersect(const NaiveNode& leaf, const PreparedRay& ray, float tmax,
                   PrimitiveHit& hit) const;
    void find_closest(const NaiveNode& node, const PreparedRay& ray, Hit& best) const;
    bool find_any(const NaiveNode& node, const PreparedRay& ray) const;

    GeometryView geometry_;
    TriangleTest test_;
    NaiveTree tree_;
    double build_s_ = 0;
};

} // namespace plumb
