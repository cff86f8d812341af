/// \file  A packet of rays against one triangle.
///
/// Operation by operation what intersect_triangle does, in the same order, as triangle_lanes.h is
/// for one ray and eight triangles: whoever changes one changes all three.
#pragma once

#include "accel/sah/isa/ray_packet.h"
#include "accel/sah/numbered_hit.h"

namespace plumb {
namespace {

/// triangle_bounds of each, as a node keeps its children's boxes.
template <class V> inline void store_bounds(const WideTriangles& block, float* planes) {
    using Floats = typename V::Floats;
    Floats lower[3], upper[3], size;
    for (int axis = 0; axis < 3; ++axis) {
        const Floats a = V::load(block.vertex[0][axis]), b = V::load(block.vertex[1][axis]);
        const Floats c = V::load(block.vertex[2][axis]);
        lower[axis] = V::min(a, V::min(b, c));
        upper[axis] = V::max(a, V::max(b, c));
        const Floats extent = upper[axis] - lower[axis];
        size = axis == 0 ? extent : V::max(size, extent);
    }
    const Floats margin = V::broadcast(8 * unit_roundoff) * size;
    const Floats ulp = V::broadcast(2 * unit_roundoff);
    for (int axis = 0; axis < 3; ++axis) {
        V::store(planes + 2 * axis * wide_width,
                 lower[axis] - (margin + ulp * V::absolute(lower[axis])));
        V::store(planes + (2 * axis + 1) * wide_width,
                 upper[axis] + (margin + ulp * V::absolute(upper[axis])));
    }
}

template <class P> struct PacketHits {
    typename P::Floats t, u, v;
    typename P::Mask hit;   ///< rays with tmin < t <= best_t; t, u and v hold there
    typename P::Mask exact; ///< rays for which intersect_triangle has to decide
};

/// See settle_lanes. `Packet`: has the rows of a RayPacket that are not of its box test.
template <class P, class Packet>
[[gnu::always_inline]] inline void settle_packet(const Packet& packet, const WideTriangles& block,
                                                 std::size_t lane, typename P::Mask candidates,
                                                 PacketHits<P>& hits) {
    using Floats = typename P::Floats;
    Floats near, far;
    for (int axis = 0; axis < 3; ++axis) {
        const float a = block.vertex[0][axis][lane], b = block.vertex[1][axis][lane];
        const float c = block.vertex[2][axis][lane];
        const Floats origin = P::load(packet.origin[axis]), inverse = P::load(packet.inverse[axis]);
        const Floats p = (P::broadcast(min(a, min(b, c))) - origin) * inverse;
        const Floats q = (P::broadcast(max(a, max(b, c))) - origin) * inverse;
        near = axis == 0 ? P::min(p, q) : P::max(P::min(p, q), near);
        far = axis == 0 ? P::max(p, q) : P::min(P::max(p, q), far);
    }
    far = P::max(far * P::broadcast(slab_padding), far); // unpadded where negative
    hits.t = P::min(far, P::max(near, hits.t));
    const auto crossed = P::not_greater(near, far);
    const Floats limit =
        P::min(P::load(packet.best_t), P::broadcast(std::numeric_limits<float>::max()));
    hits.hit = candidates & crossed & P::less(P::load(packet.tmin), hits.t) &
               P::not_greater(hits.t, limit);
    hits.exact |= candidates & static_cast<typename P::Mask>(~crossed);
}

template <class P, class Packet>
[[gnu::always_inline]] inline void
test_packet_watertight(const Packet& packet, const WideTriangles& block, std::size_t lane,
                       typename P::Mask active, PacketHits<P>& hits) {
    using Floats = typename P::Floats;
    const Floats ox = P::load(packet.origin[packet.kx]), oy = P::load(packet.origin[packet.ky]);
    const Floats oz = P::load(packet.origin[packet.kz]);
    const Floats shear_x = P::load(packet.shear[packet.kx]);
    const Floats shear_y = P::load(packet.shear[packet.ky]);
    Floats x[3], y[3], z[3];
    for (int i = 0; i < 3; ++i) {
        z[i] = P::broadcast(block.vertex[i][packet.kz][lane]) - oz;
        x[i] = P::broadcast(block.vertex[i][packet.kx][lane]) - ox - shear_x * z[i];
        y[i] = P::broadcast(block.vertex[i][packet.ky][lane]) - oy - shear_y * z[i];
    }
    const Floats u = x[2] * y[1] - y[2] * x[1];
    const Floats v = x[0] * y[2] - y[0] * x[2];
    const Floats w = x[1] * y[0] - y[1] * x[0];
    const Floats zero = P::broadcast(0);
    hits.exact = active & (P::equal(u, zero) | P::equal(v, zero) | P::equal(w, zero));
    hits.hit = P::mask(0);
    const auto mixed = P::signs_differ(u, v) | P::signs_differ(v, w);
    const auto inside =
        static_cast<typename P::Mask>(active & ~static_cast<unsigned>(mixed | hits.exact));
    if (inside == 0)
        return;
    const Floats scale = P::broadcast(1) / (u + v + w);
    const auto weigh = [](const Floats& a, const Floats& b, const Floats& c, const Floats(&at)[3]) {
        return a * at[0] + b * at[1] + c * at[2];
    };
    const float(&p)[3] = detail::projection_coefficient;
    const Floats s = shear_x * shear_x + shear_y * shear_y;
    const Floats share = P::broadcast(p[0]) + s * (P::broadcast(p[1]) + s * P::broadcast(p[2]));
    const Floats slide = (weigh(u, v, w, x) * shear_x + weigh(u, v, w, y) * shear_y) * share;
    hits.u = v * scale;
    hits.v = w * scale;
    hits.t =
        (weigh(u * scale, hits.u, hits.v, z) + slide * scale) * P::load(packet.inverse[packet.kz]);
    settle_packet<P>(packet, block, lane, inside, hits);
}

/// What the rays of a packet have found beside best_t.
template <class P> struct PacketBest {
    alignas(64) float u[P::width], v[P::width];
    alignas(64) float number[P::width]; ///< the bits of a PrimitiveNumber

    PacketBest() { P::store(number, P::broadcast(std::bit_cast<float>(invalid_id))); }

    /// Of hits at the same t the lower number stays.
    void keep(float* best_t, const PacketHits<P>& hits, PrimitiveNumber candidate) {
        const typename P::Floats old = P::load(best_t);
        unsigned closer = P::bits(hits.hit & P::less(hits.t, old));
        unsigned tied = P::bits(hits.hit & P::equal(hits.t, old));
        for (; tied != 0; tied &= tied - 1)
            if (candidate < std::bit_cast<PrimitiveNumber>(number[std::countr_zero(tied)]))
                closer |= tied & (~tied + 1);
        const auto mask = P::mask(closer);
        P::store_where(best_t, mask, hits.t);
        P::store_where(u, mask, hits.u);
        P::store_where(v, mask, hits.v);
        P::store_where(number, mask, P::broadcast(std::bit_cast<float>(candidate)));
    }
    void set(std::size_t i, const NumberedHit& hit) {
        u[i] = hit.u;
        v[i] = hit.v;
        number[i] = std::bit_cast<float>(hit.number);
    }
    [[nodiscard]] NumberedHit at(std::size_t i, float t) const {
        return {t, u[i], v[i], std::bit_cast<PrimitiveNumber>(number[i])};
    }
};

} // namespace
} // namespace plumb
