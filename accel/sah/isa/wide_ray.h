/// \file  A ray as the eight-lane tests need it.
///
/// The box test is fused: a plane's distance is `plane * inverse + addend`, one instruction in
/// place of two. Its error is relative to |origin * inverse|, not to the distance, so near planes
/// are moved nearer and far planes farther by more than that: it enters a few boxes more than
/// slab_interval and never one less. With u = 2^-24 and inv the rounded 1 / direction:
///
///   near: inverse = inv (1 - 48u), addend = -(origin inverse) - 8u |origin inverse|
///   far:  inverse = inv (1 + 40u), addend = -(origin inverse) + 8u |origin inverse|
///
/// slab_interval's own roundings are 2u on a near plane and 3u plus the padding of 32u on a far
/// one; here the product and the sum round by u each of |plane inverse| <= |distance| + |origin
/// inverse|. What is left over is positive in all four cases, by 32u on near planes: where spatial
/// splits cut a triangle, its t may lie that much before the box of the part that was hit.
///
/// Directions that are almost or exactly parallel to a plane: components below 2^-30 of the
/// largest are taken as that. It moves the ray sideways by less than 2^-29 of the distance it runs
/// within the scene, and the planes are moved by twice as much. So nothing is infinite or NaN.
#pragma once

#include "accel/prepared_ray.h"

#include <xmmintrin.h>

namespace plumb {
namespace {

/// Rays and scenes within these bounds overflow nowhere in the fused test, nor in the products of
/// three coordinates of the triangle test; others take the slow path of one box at a time.
inline constexpr float wide_max_coordinate = 0x1p38f; // cubes, 2^127 at most, are finite
inline constexpr float wide_min_direction = 0x1p-40f, wide_max_direction = 0x1p40f;

inline __m128 absolute4(__m128 x) { return _mm_andnot_ps(_mm_set1_ps(-0.0f), x); }

struct WideRay {
    // Four lanes each, so that they are made together; the last is not used.
    alignas(16) float near_inverse[4], near_addend[4], far_inverse[4], far_addend[4];
    alignas(16) float origin[4], inverse[4]; ///< as in SlabRay
    alignas(16) float direction[4];
    alignas(16) float shear[4]; ///< direction / direction[kz]
    float tmin, tmax;
    int kx, ky, kz;    ///< as in PreparedRay
    unsigned negative; ///< sign bits of the direction's components
    bool tilted;       ///< a component is next to nothing or zero: `inverse` may be infinite

    WideRay(const Ray& ray, float reach) : tmin(ray.tmin + 0.0f), tmax(ray.tmax) { // no -0
        const __m128 o = _mm_loadu_ps(&ray.origin.x), d = _mm_loadu_ps(&ray.direction.x);
        const __m128 length = absolute4(d);
        _mm_store_ps(origin, o);
        _mm_store_ps(direction, d);
        negative = static_cast<unsigned>(_mm_movemask_ps(d)) & 7u;
        kz = largest_axis(length);
        kx = 0b00'10'01 >> (2 * kz) & 3;
        ky = 0b01'00'10 >> (2 * kz) & 3;
        const __m128 largest = _mm_set1_ps(direction[kz]);
        _mm_store_ps(shear, _mm_div_ps(d, largest));
        const __m128 inv = _mm_div_ps(_mm_set1_ps(1), d);
        _mm_store_ps(inverse, inv);
        set_coefficients(o, inv, _mm_set1_ps(1e-36f)); // products below the normal numbers
        const __m128 smallest = _mm_mul_ps(absolute4(largest), _mm_set1_ps(0x1p-30f));
        tilted = (_mm_movemask_ps(_mm_cmpge_ps(length, smallest)) & 7) != 7;
        if (tilted) [[unlikely]]
            tilt(reach);
    }

    /// PreparedRay's kz without branches: which of x > y, x > z, y > z hold, and a table of two
    /// bits each.
    [[nodiscard]] static int largest_axis(__m128 length) {
        const int greater =
            _mm_movemask_ps(_mm_cmpgt_ps(_mm_shuffle_ps(length, length, _MM_SHUFFLE(3, 1, 0, 0)),
                                         _mm_shuffle_ps(length, length, _MM_SHUFFLE(3, 2, 2, 1))));
        return 0x192a >> (2 * (greater & 7)) & 3;
    }

    /// Whether the fused test may be used. Implies is_valid.
    [[nodiscard]] static bool is_ordinary(const Ray& ray, float reach) {
        const __m128 o = absolute4(_mm_loadu_ps(&ray.origin.x));
        const __m128 d = absolute4(_mm_loadu_ps(&ray.direction.x));
        const int near = _mm_movemask_ps(_mm_cmple_ps(o, _mm_set1_ps(wide_max_coordinate))) &
                         (_mm_movemask_ps(_mm_cmple_ps(d, _mm_set1_ps(wide_max_direction))) | 8);
        const int moving = _mm_movemask_ps(_mm_cmpge_ps(d, _mm_set1_ps(wide_min_direction))) & 7;
        return near == 15 && moving != 0 && ray.tmin >= 0 && ray.tmin <= ray.tmax &&
               reach <= wide_max_coordinate;
    }

    /// For the tests that need it whole.
    [[nodiscard]] PreparedRay prepared() const {
        return PreparedRay(Ray{{origin[0], origin[1], origin[2]},
                               tmin,
                               {direction[0], direction[1], direction[2]},
                               tmax});
    }

  private:
    void set_coefficients(__m128 o, __m128 inv, __m128 margin) {
        const __m128 near = _mm_mul_ps(inv, _mm_set1_ps(1 - 48 * unit_roundoff));
        const __m128 far = _mm_mul_ps(inv, _mm_set1_ps(1 + 40 * unit_roundoff));
        const __m128 eight = _mm_set1_ps(8 * unit_roundoff), zero = _mm_setzero_ps();
        const __m128 n = _mm_mul_ps(o, near), f = _mm_mul_ps(o, far);
        const __m128 n_margin = _mm_add_ps(_mm_mul_ps(eight, absolute4(n)), margin);
        const __m128 f_margin = _mm_add_ps(_mm_mul_ps(eight, absolute4(f)), margin);
        _mm_store_ps(near_inverse, near);
        _mm_store_ps(far_inverse, far);
        _mm_store_ps(near_addend, _mm_sub_ps(_mm_sub_ps(zero, n), n_margin));
        _mm_store_ps(far_addend, _mm_add_ps(_mm_sub_ps(zero, f), f_margin));
    }

    /// The coefficients where a component of the direction is next to nothing.
    __attribute__((noinline)) void tilt(float reach) {
        const float smallest = 0x1p-30f * std::fabs(direction[kz]);
        const float distance =
            reach + max(std::fabs(origin[0]), max(std::fabs(origin[1]), std::fabs(origin[2])));
        alignas(16) float inv[4], margin[4]{};
        for (int axis = 0; axis < 3; ++axis) {
            const bool parallel = !(std::fabs(direction[axis]) >= smallest);
            inv[axis] = parallel ? std::copysign(1 / smallest, direction[axis]) : inverse[axis];
            margin[axis] = parallel ? 0x1p-28f * distance / smallest : 1e-36f;
        }
        inv[3] = 0;
        set_coefficients(_mm_load_ps(origin), _mm_load_ps(inv), _mm_load_ps(margin));
    }
};

} // namespace
} // namespace plumb
