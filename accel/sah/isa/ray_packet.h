/// \file  Rays that run alike, as the packet tests need them.
#pragma once

#include "accel/sah/isa/wide_ray.h"

#include <algorithm>
#include <bit>
#include <span>

namespace plumb {
namespace {

/// How much the slopes of a packet's rays (components over the largest one) may differ: a packet
/// of rays that spread wider visits more nodes than its rays one by one.
inline constexpr float packet_max_spread = 2.0f;

/// P::width rays, of which the first `count` are there; the rest repeat the first and can hit
/// nothing.
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

    /// Between 1 and width rays.
    RayPacket(std::span<const Ray> rays, float reach) : alike(false) {
        Row direction[3];
        for (std::size_t i = 0; i < width; ++i) {
            const bool there = i < rays.size();
            const Ray& ray = rays[there ? i : 0];
            if (there && !WideRay::is_ordinary(ray, reach))
                return;
            for (int axis = 0; axis < 3; ++axis) {
                origin[axis][i] = (&ray.origin.x)[axis];
                direction[axis][i] = (&ray.direction.x)[axis];
            }
            tmin[i] = ray.tmin + 0.0f; // no -0
            best_t[i] = there ? ray.tmax : -1;
        }
        const Vec3 first = rays[0].direction, length = abs(first);
        kz = length.x > length.y ? (length.x > length.z ? 0 : 2) : (length.y > length.z ? 1 : 2);
        kx = kz == 2 ? 0 : kz + 1;
        ky = kx == 2 ? 0 : kx + 1;
        negative = 0;
        for (unsigned axis = 0; axis < 3; ++axis)
            negative |= (std::signbit((&first.x)[axis]) ? 1u : 0u) << axis;
        alike = run_alike(direction);
        if (alike)
            set_coefficients();
    }

  private:
    using Floats = typename P::Floats;

    /// Fills in inverse and shear. Whether all rays have the signs and the largest axis of the
    /// first, similar slopes, and no component next to nothing.
    bool run_alike(const Row (&direction)[3]) {
        const Floats largest = load(direction[kz]), length = P::absolute(largest);
        const Floats smallest = length * P::broadcast(0x1p-30f);
        const unsigned all = (1u << width) - 1;
        unsigned good = all;
        for (int axis = 0; axis < 3; ++axis) {
            const Floats d = load(direction[axis]);
            P::store(inverse[axis], P::broadcast(1) / d);
            P::store(shear[axis], d / largest);
            good &= ~P::bits(P::signs_differ(d, P::broadcast(direction[axis][0])));
            good &= P::bits(P::not_greater(smallest, P::absolute(d)));
        }
        // PreparedRay takes kz = 2 where z is as long as another, and 1 before 0.
        for (int axis = 0; axis < 3; ++axis) {
            const Floats other = P::absolute(load(direction[axis]));
            if (axis != kz)
                good &= P::bits(kz > axis ? P::not_greater(other, length) : P::less(other, length));
        }
        return (good & all) == all && spread(shear[kx]) < packet_max_spread &&
               spread(shear[ky]) < packet_max_spread;
    }

    static Floats load(const Row& row) {
        alignas(64) Row aligned;
        std::copy(std::begin(row), std::end(row), std::begin(aligned));
        return P::load(aligned);
    }
    static float spread(const Row& row) {
        const Floats x = P::load(row);
        return P::largest(x) - P::smallest(x);
    }

    /// As WideRay::set_coefficients.
    void set_coefficients() {
        const Floats margin = P::broadcast(1e-36f), eight = P::broadcast(8 * unit_roundoff);
        const Floats zero = P::broadcast(0);
        for (int axis = 0; axis < 3; ++axis) {
            const Floats o = P::load(origin[axis]), inv = P::load(inverse[axis]);
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

    explicit PacketHull(const RayPacket<P>& packet)
        : tmin(P::smallest(P::load(packet.tmin))), negative(packet.negative) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto o = P::load(packet.origin[axis]), inv = P::load(packet.inverse[axis]);
            const float o_low = P::smallest(o), o_high = P::largest(o);
            const float i_low = P::smallest(inv), i_high = P::largest(inv);
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
