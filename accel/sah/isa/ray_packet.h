/// \file  Rays that run alike, as the packet tests need them.
#pragma once

#include "accel/sah/isa/wide_ray.h"

#include <algorithm>
#include <bit>
#include <span>

namespace plumb {
namespace {

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
    alignas(64) Row origin[3], inverse[3], shear[3];
    alignas(64) Row tmin;
    alignas(64) Row best_t; ///< tmax at first, then the closest hits'
    int kx, ky, kz;         ///< the same for all rays, as is `negative`
    unsigned negative;
    bool alike; ///< only then does the rest hold

    /// At least one ray.
    RayPacket(std::span<const Ray* const> rays, float reach) {
        const float* start[width];
        for (std::size_t i = 0; i < width; ++i)
            start[i] = &rays[i < rays.size() ? i : 0]->origin.x;
        Floats rows[8]; // origin, tmin, direction, tmax: the members of Ray
        P::transpose(start, rows);
        const Vec3 first = rays[0]->direction, length = abs(first);
        kz = length.x > length.y ? (length.x > length.z ? 0 : 2) : (length.y > length.z ? 1 : 2);
        kx = kz == 2 ? 0 : kz + 1;
        ky = kx == 2 ? 0 : kx + 1;
        negative = 0;
        for (unsigned axis = 0; axis < 3; ++axis)
            negative |= (std::signbit((&first.x)[axis]) ? 1u : 0u) << axis;
        alike = run_alike(rows, rows + 4, reach) && are_ordinary(rows, reach);
        if (!alike)
            return;
        P::store(tmin, rows[3] + P::broadcast(0)); // no -0
        P::store(best_t, P::broadcast(-1));
        P::store_where(best_t, P::mask((1u << rays.size()) - 1), rows[7]);
        for (int axis = 0; axis < 3; ++axis)
            P::store(origin[axis], rows[axis]);
        set_coefficients(rows, inverse_rows_);
    }

  private:
    using Floats = typename P::Floats;
    static constexpr unsigned all = (1u << width) - 1;

    Floats inverse_rows_[3];

    /// Fills in inverse and shear. Whether all rays have the signs and the largest axis of the
    /// first, are near each other, and have no component next to nothing.
    bool run_alike(const Floats* o, const Floats* d, float reach) {
        const Floats longest = d[kz], length = P::absolute(longest);
        const Floats smallest = length * P::broadcast(0x1p-30f);
        unsigned good = all;
        for (int axis = 0; axis < 3; ++axis) {
            const Floats other = P::absolute(d[axis]);
            good &= ~P::bits(P::signs_differ(
                d[axis], P::broadcast((negative >> axis & 1u) != 0 ? -1.0f : 1.0f)));
            good &= P::bits(P::not_greater(smallest, other));
            // PreparedRay takes kz = 2 where z is as long as another, and 1 before 0.
            if (axis != kz)
                good &= P::bits(kz > axis ? P::not_greater(other, length) : P::less(other, length));
        }
        if ((good & all) != all)
            return false;
        const Floats max_slope = P::broadcast(packet_max_slope);
        const Floats max_origin = P::broadcast(packet_max_origin * reach);
        for (int axis = 0; axis < 3; ++axis) {
            inverse_rows_[axis] = P::broadcast(1) / d[axis];
            const Floats slope = d[axis] / longest;
            P::store(inverse[axis], inverse_rows_[axis]);
            P::store(shear[axis], slope);
            good &= P::bits(P::not_greater(from_first(slope), max_slope)) &
                    P::bits(P::not_greater(from_first(o[axis]), max_origin));
        }
        return (good & all) == all;
    }

    /// WideRay::is_ordinary of each.
    bool are_ordinary(const Floats* rows, float reach) const {
        const Floats limit = P::broadcast(wide_max_coordinate);
        const Floats length = P::absolute(rows[4 + kz]);
        unsigned good = all & P::bits(P::not_greater(P::broadcast(wide_min_direction), length)) &
                        P::bits(P::not_greater(length, P::broadcast(wide_max_direction))) &
                        P::bits(P::not_greater(P::broadcast(0), rows[3])) &
                        P::bits(P::not_greater(rows[3], rows[7]));
        for (int i = 0; i < 4; ++i)
            good &= P::bits(P::not_greater(P::absolute(rows[i]), limit));
        return good == all && reach <= wide_max_coordinate;
    }

    static Floats from_first(Floats x) { return P::absolute(x - P::repeat_first(x)); }

    /// As WideRay::set_coefficients.
    void set_coefficients(const Floats* o_rows, const Floats* inv_rows) {
        const Floats margin = P::broadcast(1e-36f), eight = P::broadcast(8 * unit_roundoff);
        const Floats zero = P::broadcast(0);
        for (int axis = 0; axis < 3; ++axis) {
            const Floats o = o_rows[axis], inv = inv_rows[axis];
            const Floats near = inv * P::broadcast(1 - 48 * unit_roundoff);
            const Floats far = inv * P::broadcast(1 + 40 * unit_roundoff);
            const Floats n = o * near, f = o * far;
            P::store(near_inverse[axis], near);
            P::store(far_inverse[axis], far);
            P::store(near_addend[axis], zero - n - (eight * P::absolute(n) + margin));
            P::store(far_addend[axis], zero - f + (eight * P::absolute(f) + margin));
        }
    }
};

/// Coefficients with which NodeTest enters a box if any ray of the packet may: the near distance
/// from the origin that is nearest to the box and the least 1 / direction, the far distance from
/// the farthest origin and the largest. (Where that near distance is negative the ray's tmin
/// counts.)
template <class P> struct PacketHull {
    float near_inverse[3], near_addend[3], far_inverse[3], far_addend[3];
    float tmin;
    unsigned negative;

    explicit PacketHull(const RayPacket<P>& packet) : negative(packet.negative) {
        // Least and, negated, largest numbers, all of them together.
        typename P::Floats origins[8], inverses[8];
        for (int axis = 0; axis < 3; ++axis) {
            origins[axis] = P::load(packet.origin[axis]);
            inverses[axis] = P::load(packet.inverse[axis]);
            origins[3 + axis] = P::negated(origins[axis]);
            inverses[3 + axis] = P::negated(inverses[axis]);
        }
        origins[6] = origins[7] = P::load(packet.tmin);
        inverses[6] = inverses[7] = inverses[0];
        float o[8], i[8];
        P::smallest(origins, o);
        P::smallest(inverses, i);
        tmin = o[6];
        for (int axis = 0; axis < 3; ++axis) {
            const float o_low = o[axis], o_high = -o[3 + axis];
            const float i_low = i[axis], i_high = -i[3 + axis];
            const bool down = (negative >> axis & 1u) != 0;
            const float near = (down ? i_high : i_low) * (1 - 48 * unit_roundoff);
            const float far = (down ? i_low : i_high) * (1 + 40 * unit_roundoff);
            const float n = (down ? o_low : o_high) * near, f = (down ? o_high : o_low) * far;
            near_inverse[axis] = near;
            far_inverse[axis] = far;
            near_addend[axis] = -n - (8 * unit_roundoff * std::fabs(n) + 1e-36f);
            far_addend[axis] = -f + (8 * unit_roundoff * std::fabs(f) + 1e-36f);
        }
    }
};

} // namespace
} // namespace plumb
