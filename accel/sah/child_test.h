/// \file  Which of a node's two children a ray enters, host and device.
#pragma once

#include "accel/sah/sah_view.h"

namespace plumb {

struct ChildOverlap {
    unsigned mask; ///< bit i: child i is entered
    float near[2]; ///< max(tmin, t where child i is entered)
};

class ChildTest {
  public:
    RT_HD explicit ChildTest(const PreparedRay& ray)
        : slab_(ray.slab), tmin_(ray.tmin), tmax_(ray.tmax) {}

    RT_HD void limit(float tmax) { tmax_ = tmax; }

    RT_HD ChildOverlap operator()(const SahNode& node) const {
        ChildOverlap overlap{0, {0, 0}};
        for (int i = 0; i < 2; ++i) {
            const Interval interval = slab_interval(slab_, node.bounds(i));
            overlap.near[i] = max(interval.near, tmin_);
            if (overlaps(interval, tmin_, tmax_))
                overlap.mask |= 1u << i;
        }
        return overlap;
    }

  private:
    SlabRay slab_;
    float tmin_, tmax_;
};

} // namespace plumb
