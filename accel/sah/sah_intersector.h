/// \file  The SAH tree as an Intersector.
#pragma once

#include "accel/intersector.h"
#include "accel/sah/build_sah.h"

namespace plumb {

class SahIntersector : public Intersector {
  public:
    using Intersector::closest;
    using Intersector::occluded;
    [[nodiscard]] AccelStats stats() const override;
    /// What kernels traverse and upload. Valid as long as the intersector lives.
    [[nodiscard]] const SahView& view() const { return view_; }

  protected:
    /// Builds; see build_sah for what it throws.
    explicit SahIntersector(const GeometryView& geometry);

  private:
    SahTree tree_;
    SahView view_;
    double build_s_ = 0;
};

/// One class a triangle test, so that no ray asks which.
[[nodiscard]] std::unique_ptr<SahIntersector> make_sah_intersector(const GeometryView& geometry,
                                                                   TriangleTest test);

} // namespace plumb
