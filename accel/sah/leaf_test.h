/// \file  The triangles of one leaf against a ray, host and device.
///
/// All lanes of a block pass a filter together; the few that remain go through intersect_triangle,
/// the one formula that decides. The filter drops a triangle only where the watertight test does:
/// the edge functions have both signs and none is zero. The same operations in the same order give
/// the same bits in a lane as in a scalar.
#pragma once

#include "accel/sah/sah_view.h"

#include <bit>

#if defined(__SSE2__) && !defined(__CUDACC__)
#include <immintrin.h>
#endif

namespace plumb {

#if defined(__SSE2__) && !defined(__CUDACC__)

namespace detail {

#ifdef __AVX__
using Lanes = __m256;
inline Lanes load(const float* p) { return _mm256_load_ps(p); }
inline Lanes broadcast(float x) { return _mm256_set1_ps(x); }
inline Lanes is_zero(Lanes x) { return _mm256_cmp_ps(x, _mm256_setzero_ps(), _CMP_EQ_OQ); }
inline Lanes either(Lanes a, Lanes b) { return _mm256_or_ps(a, b); }
inline Lanes differ(Lanes a, Lanes b) { return _mm256_xor_ps(a, b); }
inline int sign_mask(Lanes x) { return _mm256_movemask_ps(x); }
#else
using Lanes = __m128;
inline Lanes load(const float* p) { return _mm_load_ps(p); }
inline Lanes broadcast(float x) { return _mm_set1_ps(x); }
inline Lanes is_zero(Lanes x) { return _mm_cmpeq_ps(x, _mm_setzero_ps()); }
inline Lanes either(Lanes a, Lanes b) { return _mm_or_ps(a, b); }
inline Lanes differ(Lanes a, Lanes b) { return _mm_xor_ps(a, b); }
inline int sign_mask(Lanes x) { return _mm_movemask_ps(x); }
#endif
inline constexpr std::uint32_t lane_count = sizeof(Lanes) / sizeof(float);

} // namespace detail

/// Bit i: lane i may be hit by the watertight test. Lanes from `count` on are never set.
inline std::uint32_t candidate_lanes(const PreparedRay& ray, const TriangleBlock& block,
                                     std::uint32_t count) {
    using namespace detail;
    const float* origin = &ray.slab.origin.x;
    const Lanes ox = broadcast(origin[ray.kx]), oy = broadcast(origin[ray.ky]);
    const Lanes oz = broadcast(origin[ray.kz]);
    const Lanes shear_x = broadcast(ray.shear_x), shear_y = broadcast(ray.shear_y);
    std::uint32_t candidates = 0;
    for (std::uint32_t lane = 0; lane < sah_max_leaf_size; lane += lane_count) {
        Lanes x[3], y[3];
        for (int i = 0; i < 3; ++i) {
            const Lanes z = load(&block.vertex[i][ray.kz][lane]) - oz;
            x[i] = load(&block.vertex[i][ray.kx][lane]) - ox - shear_x * z;
            y[i] = load(&block.vertex[i][ray.ky][lane]) - oy - shear_y * z;
        }
        const Lanes u = x[2] * y[1] - y[2] * x[1];
        const Lanes v = x[0] * y[2] - y[0] * x[2];
        const Lanes w = x[1] * y[0] - y[1] * x[0];
        const int mixed = sign_mask(either(differ(u, v), differ(v, w)));
        const int zero = sign_mask(either(is_zero(u), either(is_zero(v), is_zero(w))));
        candidates |= static_cast<std::uint32_t>(zero | ~mixed) << lane;
    }
    return candidates & ((1u << count) - 1);
}

#else

/// Every lane that holds a triangle.
RT_HD inline std::uint32_t candidate_lanes(const PreparedRay&, const TriangleBlock&,
                                           std::uint32_t count) {
    return (1u << count) - 1;
}

#endif

/// The first lane at or after the lowest set bit, and the mask without it.
RT_HD inline std::uint32_t lowest_bit(std::uint32_t mask) {
#ifdef __CUDA_ARCH__
    return static_cast<std::uint32_t>(__ffs(static_cast<int>(mask)) - 1);
#else
    return static_cast<std::uint32_t>(std::countr_zero(mask));
#endif
}

/// Calls visit(lane) for each triangle of a leaf that `Test` might hit, until it returns true.
/// Returns whether it did.
template <TriangleTest Test, class Visit>
RT_HD inline bool any_candidate(const PreparedRay& ray, const TriangleBlock& block,
                                std::uint32_t count, Visit&& visit) {
    std::uint32_t lanes = (1u << count) - 1;
    if constexpr (Test == TriangleTest::watertight)
        lanes = candidate_lanes(ray, block, count);
    for (; lanes != 0; lanes &= lanes - 1)
        if (visit(lowest_bit(lanes)))
            return true;
    return false;
}

} // namespace plumb
