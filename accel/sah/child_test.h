/// \file  Which of a node's two children a ray enters, host and device.
///
/// The boxes may be culled by any conservative arithmetic (see settle): this one differs from
/// overlaps(slab_interval(...)) only in that the padding is applied to min(far, tmax), which enters
/// a few boxes more and never one less.
#pragma once

#include "accel/sah/sah_view.h"

#if defined(__SSE2__) && !defined(__CUDACC__)
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
    explicit ChildTest(const PreparedRay& ray) {
        const float* origin = &ray.slab.origin.x;
        const float* inverse = &ray.slab.inv_direction.x;
        for (int axis = 0; axis < 3; ++axis) {
            origin_[axis] = _mm_set1_ps(origin[axis]);
            inverse_[axis] =
                _mm_setr_ps(inverse[axis], inverse[axis], -inverse[axis], -inverse[axis]);
            near_[axis] = 4 * axis + (ray.slab.negative[axis] ? 2 : 0);
            far_[axis] = 4 * axis + (ray.slab.negative[axis] ? 0 : 2);
        }
        tmin_ = ray.tmin;
    }

    ChildOverlap operator()(const SahNode& node, float tmax) const {
        const float* planes = &node.planes[0][0];
        __m128 clip = _mm_setr_ps(tmin_, tmin_, -tmax, -tmax);
        for (int axis = 0; axis < 3; ++axis) {
            __m128 plane = _mm_castsi128_ps(
                _mm_loadl_epi64(reinterpret_cast<const __m128i*>(planes + near_[axis])));
            plane = _mm_loadh_pi(plane, reinterpret_cast<const __m64*>(planes + far_[axis]));
            clip = _mm_max_ps(_mm_mul_ps(_mm_sub_ps(plane, origin_[axis]), inverse_[axis]), clip);
        }
        const __m128 far = _mm_mul_ps(_mm_movehl_ps(clip, clip), _mm_set1_ps(-slab_padding));
        ChildOverlap overlap;
        overlap.mask = static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(clip, far))) & 3u;
        overlap.near[0] = _mm_cvtss_f32(clip);
        overlap.near[1] = _mm_cvtss_f32(_mm_shuffle_ps(clip, clip, 1));
        return overlap;
    }

  private:
    __m128 origin_[3], inverse_[3];
    std::ptrdiff_t near_[3], far_[3]; ///< offsets of the planes in floats
    float tmin_;
};

#else

class ChildTest {
  public:
    RT_HD explicit ChildTest(const PreparedRay& ray) : slab_(ray.slab), tmin_(ray.tmin) {}

    RT_HD ChildOverlap operator()(const SahNode& node, float tmax) const {
        ChildOverlap overlap{0, {0, 0}};
        for (int i = 0; i < 2; ++i) {
            const Interval interval = slab_interval(slab_, node.bounds(i));
            overlap.near[i] = max(interval.near, tmin_);
            if (overlaps(interval, tmin_, tmax))
                overlap.mask |= 1u << i;
        }
        return overlap;
    }

  private:
    SlabRay slab_;
    float tmin_;
};

#endif

} // namespace plumb
