/// \file  Eight triangles against one ray.
///
/// Operation by operation what intersect_triangle does, in the same order, so that a lane holds the
/// same bits as the scalar: whoever changes one changes the other, and the tests compare them.
/// Where an edge function is zero the scalar test falls back on double; those lanes are handed to
/// it.
#pragma once

#include "accel/sah/isa/wide_ray.h"
#include "accel/sah/wide_bvh.h"

#include <bit>

namespace plumb {
namespace {

/// Candidate hits by lane.
template <class V> struct LaneHits {
    alignas(32) float t[wide_width], u[wide_width], v[wide_width];
    unsigned hit;   ///< lanes with tmin < t <= tmax; t, u and v hold there
    unsigned exact; ///< lanes that intersect_triangle has to decide
};

/// What follows a candidate t in intersect_triangle: t is moved into the interval of the box of the
/// vertices. Sorts the candidates into hits, others and those that the scalar test has to decide:
/// where the ray passes beside that box by a rounding error, and all of a tilted ray. Others' 1 /
/// direction is finite, so that no NaN comes up and the lesser plane distance is the near one.
template <class V>
[[gnu::always_inline]] inline void settle_lanes(const WideRay& ray, const WideTriangles& block,
                                                float tmax, unsigned candidates,
                                                typename V::Floats& t, LaneHits<V>& hits) {
    using Floats = typename V::Floats;
    if (ray.tilted) [[unlikely]] {
        hits.exact |= candidates;
        return;
    }
    Floats near, far;
    for (int axis = 0; axis < 3; ++axis) {
        const Floats a = V::load(block.vertex[0][axis]), b = V::load(block.vertex[1][axis]);
        const Floats c = V::load(block.vertex[2][axis]);
        const Floats origin = V::broadcast(ray.origin[axis]);
        const Floats inverse = V::broadcast(ray.inverse[axis]);
        const Floats p = (V::min(a, V::min(b, c)) - origin) * inverse;
        const Floats q = (V::max(a, V::max(b, c)) - origin) * inverse;
        near = axis == 0 ? V::min(p, q) : V::max(V::min(p, q), near);
        far = axis == 0 ? V::max(p, q) : V::min(V::max(p, q), far);
    }
    far = V::max(far * V::broadcast(slab_padding), far); // unpadded where negative
    t = V::min(far, V::max(near, t));
    const Floats crossed = V::not_greater(near, far);
    const Floats in_range =
        V::both(V::less(V::broadcast(ray.tmin), t),
                V::not_greater(t, V::broadcast(min(tmax, std::numeric_limits<float>::max()))));
    hits.hit = candidates & V::bits(V::both(crossed, in_range));
    hits.exact |= candidates & ~V::bits(crossed);
}

/// Vertices relative to the origin and sheared; edge functions. Coordinates of ordinary rays and
/// trees are too small to overflow.
template <class V>
[[gnu::always_inline]] inline void test_watertight(const WideRay& ray, const WideTriangles& block,
                                                   float tmax, LaneHits<V>& hits) {
    using Floats = typename V::Floats;
    const Floats ox = V::broadcast(ray.origin[ray.kx]), oy = V::broadcast(ray.origin[ray.ky]);
    const Floats oz = V::broadcast(ray.origin[ray.kz]);
    const Floats shear_x = V::broadcast(ray.shear[ray.kx]);
    const Floats shear_y = V::broadcast(ray.shear[ray.ky]);
    Floats x[3], y[3], z[3];
    for (int i = 0; i < 3; ++i) {
        z[i] = V::load(block.vertex[i][ray.kz]) - oz;
        x[i] = V::load(block.vertex[i][ray.kx]) - ox - shear_x * z[i];
        y[i] = V::load(block.vertex[i][ray.ky]) - oy - shear_y * z[i];
    }
    const Floats u = x[2] * y[1] - y[2] * x[1];
    const Floats v = x[0] * y[2] - y[0] * x[2];
    const Floats w = x[1] * y[0] - y[1] * x[0];
    const Floats zero = V::broadcast(0);
    const Floats on_edge =
        V::either(V::either(V::equal(u, zero), V::equal(v, zero)), V::equal(w, zero));
    const Floats mixed = V::either(V::exclusive_or(u, v), V::exclusive_or(v, w));
    hits.hit = 0;
    hits.exact = V::bits(on_edge);
    const unsigned inside = ~(V::bits(mixed) | hits.exact) & 0xffu;
    if (inside == 0)
        return;
    const Floats scale = V::broadcast(1) / (u + v + w);
    const auto weigh = [](const Floats& a, const Floats& b, const Floats& c, const Floats(&at)[3]) {
        return a * at[0] + b * at[1] + c * at[2];
    };
    const float(&p)[3] = detail::projection_coefficient;
    const float s = ray.shear[ray.kx] * ray.shear[ray.kx] + ray.shear[ray.ky] * ray.shear[ray.ky];
    const Floats share = V::broadcast(p[0] + s * (p[1] + s * p[2]));
    const Floats slide = (weigh(u, v, w, x) * shear_x + weigh(u, v, w, y) * shear_y) * share;
    const Floats weight_b = v * scale, weight_c = w * scale;
    Floats t = (weigh(u * scale, weight_b, weight_c, z) + slide * scale) *
               V::broadcast(ray.inverse[ray.kz]);
    settle_lanes<V>(ray, block, tmax, inside, t, hits);
    if (hits.hit == 0)
        return;
    V::store(hits.t, t);
    V::store(hits.u, weight_b);
    V::store(hits.v, weight_c);
}

template <class V> struct Lanes3 {
    typename V::Floats x, y, z;

    Lanes3(typename V::Floats a, typename V::Floats b, typename V::Floats c) : x(a), y(b), z(c) {}
    explicit Lanes3(const float (&p)[4])
        : x(V::broadcast(p[0])), y(V::broadcast(p[1])), z(V::broadcast(p[2])) {}
    Lanes3(const WideTriangles& block, int corner)
        : x(V::load(block.vertex[corner][0])), y(V::load(block.vertex[corner][1])),
          z(V::load(block.vertex[corner][2])) {}
    friend Lanes3 operator-(const Lanes3& a, const Lanes3& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend typename V::Floats dot(const Lanes3& a, const Lanes3& b) {
        return a.x * b.x + a.y * b.y + a.z * b.z;
    }
    friend Lanes3 cross(const Lanes3& a, const Lanes3& b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
};

template <class V>
[[gnu::always_inline]] inline void test_moeller_trumbore(const WideRay& ray,
                                                         const WideTriangles& block, float tmax,
                                                         LaneHits<V>& hits) {
    using Floats = typename V::Floats;
    const Lanes3<V> a(block, 0), direction(ray.direction);
    const Lanes3<V> e1 = Lanes3<V>(block, 1) - a, e2 = Lanes3<V>(block, 2) - a;
    const Floats zero = V::broadcast(0), one = V::broadcast(1);
    const Lanes3<V> p = cross(direction, e2);
    const Floats det = dot(e1, p);
    const Lanes3<V> s = Lanes3<V>(ray.origin) - a;
    const Floats u = dot(s, p) / det;
    const Lanes3<V> q = cross(s, e1);
    const Floats v = dot(direction, q) / det;
    Floats t = dot(e2, q) / det;
    const unsigned inside =
        V::bits(V::both(V::both(V::not_greater(zero, u), V::not_greater(u, one)),
                        V::both(V::not_greater(zero, v), V::not_greater(u + v, one)))) &
        ~V::bits(V::equal(det, zero));
    hits.hit = 0;
    hits.exact = 0;
    if (inside != 0)
        settle_lanes<V>(ray, block, tmax, inside, t, hits);
    if (hits.hit == 0)
        return;
    V::store(hits.t, t);
    V::store(hits.u, u);
    V::store(hits.v, v);
}

/// intersect_triangle, compiled into this file alone: of a shared instance the linker could take
/// the one of another instruction set.
template <TriangleTest Test>
[[gnu::flatten, gnu::noinline]] bool intersect_exactly(const PreparedRay& ray,
                                                       const WideTriangles& block, int lane,
                                                       float tmax, PrimitiveHit& hit) {
    return intersect_triangle<Test>(ray, block.corner(0, lane), block.corner(1, lane),
                                    block.corner(2, lane), tmax, hit);
}

/// Calls visit(lane, hit) for each triangle of a block that is hit with tmin < t <= tmax, until it
/// returns true. Returns whether it did.
template <class V, TriangleTest Test, class Visit>
[[gnu::always_inline]] inline bool visit_triangles(const WideRay& ray, const WideTriangles& block,
                                                   float tmax, Visit&& visit) {
    LaneHits<V> hits;
    if constexpr (Test == TriangleTest::watertight)
        test_watertight<V>(ray, block, tmax, hits);
    else
        test_moeller_trumbore<V>(ray, block, tmax, hits);
    for (unsigned rest = hits.hit; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        if (visit(lane, PrimitiveHit{hits.t[lane], hits.u[lane], hits.v[lane]}))
            return true;
    }
    for (unsigned rest = hits.exact; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        PrimitiveHit hit;
        if (intersect_exactly<Test>(ray.prepared(), block, static_cast<int>(lane), tmax, hit) &&
            visit(lane, hit))
            return true;
    }
    return false;
}

} // namespace
} // namespace plumb
