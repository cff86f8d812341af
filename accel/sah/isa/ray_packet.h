/// \file  Rays that run alike, as the packet tests need them.
#pragma once

#include "accel/sah/isa/wide_ray.h"

#include <algorithm>
#include <bit>
#include <span>

namespace plumb {
namespace {

/// Numbers of rays of a stream.
using RayIndices = std::span<const std::uint32_t>;

/// Some rays of a stream, in its order.
struct PacketRays {
    const Ray* stream;
    RayIndices indices;

    const Ray& operator[](std::size_t i) const { return stream[indices[i]]; }
};
static_assert(sizeof(Ray) == 8 * sizeof(float));

/// How far a packet's rays may be from its first: in the slope (components over the largest one),
/// and in the origin, as a share of the scene. A packet that spreads wider visits more nodes than
/// its rays one by one.
inline constexpr float packet_max_slope = 0.6f, packet_max_origin = 0.075f;

/// Up to P::width rays. Where there are fewer, the rest repeat the first and can hit nothing.
template <class P> struct RayPacket {
    using Lanes = P;
    static constexpr std::size_t width = P::width;
    using Row = float[width];

    alignas(64) Row near_inverse[3], near_addend[3], far_inverse[3], far_addend[3]; ///< as WideRay
    alignas(64) Row origin[3], inverse[3], shear[3]; ///< no shear of kz
    alignas(64) Row tmin;
    alignas(64) Row best_t; ///< tmax at first, then the closest hits'
    int kx, ky, kz;         ///< the same for all rays, as is `negative`
    unsigned negative;
    bool alike; ///< only then does the rest hold

    /// At least one ray.
    RayPacket(const PacketRays& rays, float reach) {
        Floats rows[8]; // origin, tmin, direction, tmax: the members of Ray
        const std::size_t count = rays.indices.size();
        if (count == width && rays.indices[width - 1] - rays.indices[0] == width - 1) [[likely]] {
            const float* const start = &rays[0].origin.x;
            P::transpose([start](int i) { return start + 8 * i; }, rows);
        } else {
            const float* start[width];
            for (std::size_t i = 0; i < width; ++i)
                start[i] = &rays[i < count ? i : 0].origin.x;
            P::transpose([&start](int i) { return start[i]; }, rows);
        }
        const __m128 first = _mm_loadu_ps(&rays[0].direction.x);
        kz = WideRay::largest_axis(absolute4(first));
        kx = kz == 2 ? 0 : kz + 1;
        ky = kx == 2 ? 0 : kx + 1;
        negative = static_cast<unsigned>(_mm_movemask_ps(first)) & 7u;
        // The axis as a constant, so that all rows stay in registers.
        alike = kz == 0 ? set_up<0>(rows, reach)
                        : (kz == 1 ? set_up<1>(rows, reach) : set_up<2>(rows, reach));
        P::store(best_t, P::broadcast(-1));
        P::store_where(best_t, P::mask((1u << count) - 1), rows[7]);
    }

  private:
    using Floats = typename P::Floats;
    static constexpr unsigned all = (1u << width) - 1;

    /// Fills in all but best_t, if the rays have the signs and the largest axis of the first, are
    /// near each other and ordinary, and have no component next to nothing. Returns whether they
    /// do.
    template <int Z> bool set_up(const Floats (&rows)[8], float reach) {
        constexpr int X = Z == 2 ? 0 : Z + 1, Y = X == 2 ? 0 : X + 1;
        const Floats* const d = rows + 4;
        const Floats length = P::absolute(d[Z]);
        const Floats smallest = length * P::broadcast(0x1p-30f);
        // WideRay::is_ordinary of each.
        const Floats limit = P::broadcast(wide_max_coordinate);
        auto good = P::not_greater(P::broadcast(wide_min_direction), length) &
                    P::not_greater(length, P::broadcast(wide_max_direction)) &
                    P::not_greater(P::broadcast(0), rows[3]) & P::not_greater(rows[3], rows[7]) &
                    P::not_greater(rows[3], limit);
        unsigned signs = 0;
        for (int axis = 0; axis < 3; ++axis) {
            signs |= P::signs(d[axis]) ^ ((negative >> axis & 1u) != 0 ? all : 0u);
            good &= P::not_greater(P::absolute(rows[axis]), limit);
        }
        for (const int axis : {X, Y}) {
            const Floats other = P::absolute(d[axis]);
            // PreparedRay takes kz = 2 where z is as long as another, and 1 before 0.
            good &= P::not_greater(smallest, other) &
                    (Z > axis ? P::not_greater(other, length) : P::less(other, length));
        }
        const Floats slope_x = d[X] / d[Z], slope_y = d[Y] / d[Z];
        const Floats max_slope = P::broadcast(packet_max_slope);
        const Floats max_origin = P::broadcast(packet_max_origin * reach);
        good &= P::not_greater(from_first(slope_x), max_slope) &
                P::not_greater(from_first(slope_y), max_slope);
        for (int axis = 0; axis < 3; ++axis)
            good &= P::not_greater(from_first(rows[axis]), max_origin);
        if (signs != 0 || static_cast<unsigned>(good) != all || !(reach <= wide_max_coordinate))
            return false;
        P::store(shear[X], slope_x);
        P::store(shear[Y], slope_y);
        P::store(tmin, rows[3] + P::broadcast(0)); // no -0
        for (int axis = 0; axis < 3; ++axis)
            set_coefficients(axis, rows[axis], P::broadcast(1) / d[axis]);
        return true;
    }

    static Floats from_first(Floats x) { return P::absolute(x - P::repeat_first(x)); }

    /// As WideRay::set_coefficients.
    [[gnu::always_inline]] void set_coefficients(int axis, Floats o, Floats inv) {
        const Floats margin = P::broadcast(1e-36f), eight = P::broadcast(8 * unit_roundoff);
        const Floats zero = P::broadcast(0);
        const Floats near = inv * P::broadcast(1 - 48 * unit_roundoff);
        const Floats far = inv * P::broadcast(1 + 40 * unit_roundoff);
        const Floats n = o * near, f = o * far;
        P::store(origin[axis], o);
        P::store(inverse[axis], inv);
        P::store(near_inverse[axis], near);
        P::store(far_inverse[axis], far);
        P::store(near_addend[axis], zero - n - (eight * P::absolute(n) + margin));
        P::store(far_addend[axis], zero - f + (eight * P::absolute(f) + margin));
    }
};

/// Coefficients with which NodeTest enters a box if any ray of the packet may: the near distance
/// from the origin that is nearest to the box and the least 1 / direction, the far distance from
/// the farthest origin and the largest. (Where that near distance is negative the ray's tmin
/// counts.)
template <class P> struct PacketHull {
    alignas(16) float near_inverse[4], near_addend[4], far_inverse[4], far_addend[4];
    float tmin;
    unsigned negative;

    explicit PacketHull(const RayPacket<P>& packet) : negative(packet.negative) {
        // Least and, negated, largest numbers, all of them together.
        typename P::Floats rows[16];
        for (int axis = 0; axis < 3; ++axis) {
            rows[axis] = P::load(packet.origin[axis]);
            rows[4 + axis] = P::negated(rows[axis]);
            rows[8 + axis] = P::load(packet.inverse[axis]);
            rows[12 + axis] = P::negated(rows[8 + axis]);
        }
        rows[3] = rows[7] = rows[11] = rows[15] = P::load(packet.tmin);
        __m128 least[4];
        P::smallest(rows, least);
        tmin = _mm_cvtss_f32(_mm_shuffle_ps(least[0], least[0], 0xff));
        const __m128 minus = _mm_set1_ps(-0.0f);
        const __m128 o_low = least[0], o_high = _mm_xor_ps(least[1], minus);
        const __m128 i_low = least[2], i_high = _mm_xor_ps(least[3], minus);
        const __m128 down = // all bits of an axis
            _mm_castsi128_ps(_mm_srai_epi32(_mm_castps_si128(i_low), 31));
        const auto choose = [down](__m128 where_down, __m128 where_up) {
            return _mm_or_ps(_mm_and_ps(down, where_down), _mm_andnot_ps(down, where_up));
        };
        const __m128 near = _mm_mul_ps(choose(i_high, i_low), _mm_set1_ps(1 - 48 * unit_roundoff));
        const __m128 far = _mm_mul_ps(choose(i_low, i_high), _mm_set1_ps(1 + 40 * unit_roundoff));
        const __m128 n = _mm_mul_ps(choose(o_low, o_high), near);
        const __m128 f = _mm_mul_ps(choose(o_high, o_low), far);
        const auto margin = [](__m128 x) {
            return _mm_add_ps(_mm_mul_ps(_mm_set1_ps(8 * unit_roundoff), absolute4(x)),
                              _mm_set1_ps(1e-36f));
        };
        _mm_store_ps(near_inverse, near);
        _mm_store_ps(far_inverse, far);
        _mm_store_ps(near_addend, _mm_sub_ps(_mm_xor_ps(n, minus), margin(n)));
        _mm_store_ps(far_addend, _mm_add_ps(_mm_xor_ps(f, minus), margin(f)));
    }
};

} // namespace
} // namespace plumb
