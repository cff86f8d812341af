/// \file  Which of a node's two children a ray enters, host and device.
///
/// The boxes may be culled by any conservative arithmetic (see settle): this one differs from
/// overlaps(slab_interval(...)) only in that the padding is applied to min(far, tmax), which enters
/// a few boxes more and never one less.
#pragma once

#include "accel/sah/sah_view.h"

#if defined(__SSE2__) && !defined(__CUDACC__)
#include <cstddef>
#include <emmintrin.h>
#endif

namespace plumb {

struct ChildOverlap {
    unsigned mask; ///< bit i: child i is entered
    float near[2]; ///< max(tmin, t where child i is entered)
};

#if defined(__SSE2__) && !defined(__CUDACC__)

/// Both children at once. The lanes are {near 0, near 1, -far 0, -far 1}: negating the far
/// distances makes one chain of maxima out of maxima and minima. maxps(x, y) is x > y ? x : y, so a
/// NaN in x (0 * inf: a ray along a plane it starts on) leaves y, as in slab_interval.
class ChildTest {
  public:
    explicit ChildTest(const PreparedRay& ray) : ends_(_mm_set1_ps(ray.tmin)) {
        limit(ray.tmax);
        for (int axis = 0; axis < 3; ++axis) {
            origin_[axis] = _mm_set1_ps((&ray.slab.origin.x)[axis]);
            inverse_[axis] = _mm_xor_ps(_mm_set1_ps((&ray.slab.inv_direction.x)[axis]),
                                        _mm_setr_ps(0.0f, 0.0f, -0.0f, -0.0f));
            near_[axis] = ray.slab.negative[axis] ? 2 : 0;
            far_[axis] = ray.slab.negative[axis] ? 0 : 2;
        }
    }

    /// Boxes that begin beyond tmax are no longer entered.
    void limit(float tmax) { ends_ = _mm_movelh_ps(ends_, _mm_set1_ps(-tmax)); }

    ChildOverlap operator()(const SahNode& node) const {
        __m128 clip = ends_;
        for (int axis = 0; axis < 3; ++axis) {
            const float* planes = node.planes[axis];
            const __m128 near = _mm_castsi128_ps(
                _mm_loadl_epi64(reinterpret_cast<const __m128i_u*>(planes + near_[axis])));
            const __m128 plane =
                _mm_loadh_pi(near, reinterpret_cast<const __m64*>(planes + far_[axis]));
            clip = _mm_max_ps(_mm_mul_ps(_mm_sub_ps(plane, origin_[axis]), inverse_[axis]), clip);
        }
        const __m128 far = _mm_mul_ps(_mm_movehl_ps(clip, clip), _mm_set1_ps(-slab_padding));
        return {static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(clip, far))) & 3u,
                {_mm_cvtss_f32(clip), _mm_cvtss_f32(_mm_shuffle_ps(clip, clip, 1))}};
    }

  private:
    __m128 ends_; ///< {tmin, tmin, -tmax, -tmax}
    __m128 origin_[3], inverse_[3];
    std::ptrdiff_t near_[3], far_[3]; ///< where a node keeps these planes of an axis
};

#else

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

#endif

} // namespace plumb
