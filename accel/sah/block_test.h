/// \file  The triangles of one leaf against a ray, host and device.
///
/// On the host all lanes run through the watertight test together: operation by operation what
/// intersect_triangle does, in the same order, so that a lane holds the same bits as the scalar.
/// Where an edge function is zero the scalar falls back on double; those lanes are handed to it.
#pragma once

#include "accel/sah/lanes.h"
#include "accel/sah/sah_view.h"

#include <bit>

namespace plumb {

#if defined(__SSE2__) && !defined(__CUDACC__)

namespace detail {

using lanes::Lanes;

/// Vertices relative to the origin and sheared (see shear), z not yet scaled; edge functions.
struct ShearedLanes {
    Lanes z[3], u, v, w;

    ShearedLanes(const PreparedRay& ray, const TriangleBlock& block, std::uint32_t lane) {
        const float* origin = &ray.slab.origin.x;
        const Lanes ox = lanes::broadcast(origin[ray.kx]), oy = lanes::broadcast(origin[ray.ky]);
        const Lanes oz = lanes::broadcast(origin[ray.kz]);
        const Lanes shear_x = lanes::broadcast(ray.shear_x);
        const Lanes shear_y = lanes::broadcast(ray.shear_y);
        Lanes x[3], y[3];
        for (int i = 0; i < 3; ++i) {
            z[i] = lanes::load(&block.vertex[i][ray.kz][lane]) - oz;
            x[i] = lanes::load(&block.vertex[i][ray.kx][lane]) - ox - shear_x * z[i];
            y[i] = lanes::load(&block.vertex[i][ray.ky][lane]) - oy - shear_y * z[i];
        }
        u = x[2] * y[1] - y[2] * x[1];
        v = x[0] * y[2] - y[0] * x[2];
        w = x[1] * y[0] - y[1] * x[0];
    }

    /// Lanes where an edge function is zero.
    [[nodiscard]] std::uint32_t zero() const {
        const Lanes none = lanes::broadcast(0);
        return lanes::equal(u, none) | lanes::equal(v, none) | lanes::equal(w, none);
    }
    /// Lanes whose edge functions differ in sign. Meaningful where none is zero.
    [[nodiscard]] std::uint32_t mixed() const {
        return lanes::signs(lanes::exclusive_or(u, v)) | lanes::signs(lanes::exclusive_or(v, w));
    }
};

struct IntervalLanes {
    Lanes near, far;

    /// slab_interval of the box [lower, upper] of each lane.
    template <class Plane> IntervalLanes(const SlabRay& ray, Plane plane) {
        near = lanes::broadcast(-infinity);
        far = lanes::broadcast(infinity);
        for (int axis = 0; axis < 3; ++axis) {
            const Lanes origin = lanes::broadcast((&ray.origin.x)[axis]);
            const Lanes inverse = lanes::broadcast((&ray.inv_direction.x)[axis]);
            const bool negative = ray.negative[axis];
            near = lanes::max((plane(axis, negative) - origin) * inverse, near);
            far = lanes::min((plane(axis, !negative) - origin) * inverse, far);
        }
        far = lanes::max(far * lanes::broadcast(slab_padding),
                         far); // unpadded where negative
    }
};

} // namespace detail

/// Hits by lane; t, u and v hold where the lane's bit is set.
struct BlockHits {
    alignas(32) float t[sah_max_leaf_size], u[sah_max_leaf_size], v[sah_max_leaf_size];
    std::uint32_t hit = 0;   ///< lanes with tmin < t <= tmax
    std::uint32_t exact = 0; ///< lanes that intersect_triangle has to decide in double
};

/// intersect_triangle<watertight> for the first `count` lanes.
inline void test_block(const PreparedRay& ray, const TriangleBlock& block, std::uint32_t count,
                       float tmax, BlockHits& hits) {
    using namespace lanes;
    for (std::uint32_t lane = 0; lane < sah_max_leaf_size; lane += lanes::count) {
        const detail::ShearedLanes s(ray, block, lane);
        const std::uint32_t filled = ((1u << count) - 1) >> lane;
        const std::uint32_t zero = s.zero() & filled;
        const std::uint32_t inside = ~s.mixed() & ~zero & filled;
        hits.exact |= zero << lane;
        if (inside == 0)
            continue;
        const Lanes det = s.u + s.v + s.w;
        const Lanes u = s.v / det, v = s.w / det;
        const Lanes z = s.u / det * s.z[0] + u * s.z[1] + v * s.z[2];
        Lanes t = z * broadcast(ray.shear_z);
        const detail::IntervalLanes tight(ray.slab, [&](int axis, bool upper) {
            const Lanes a = load(&block.vertex[0][axis][lane]);
            const Lanes b = load(&block.vertex[1][axis][lane]);
            const Lanes c = load(&block.vertex[2][axis][lane]);
            return upper ? max(a, max(b, c)) : min(a, min(b, c));
        });
        t = min(max(tight.near, tight.far), max(min(tight.near, tight.far), t));
        const detail::IntervalLanes own(ray.slab, [&](int axis, bool upper) {
            return load(&block.bounds[upper ? 1 : 0][axis][lane]);
        });
        const unsigned is_number = equal(t, t);
        t = min(max(t, own.near), own.far);
        const std::uint32_t hit =
            inside & not_greater(own.near, own.far) & is_number & ~equal(det, broadcast(0)) &
            less(max(det, broadcast(0) - det), broadcast(infinity)) & less(broadcast(ray.tmin), t) &
            not_greater(t, broadcast(tmax)) & less(t, broadcast(infinity));
        if (hit == 0)
            continue;
        store(&hits.t[lane], t);
        store(&hits.u[lane], u);
        store(&hits.v[lane], v);
        hits.hit |= hit << lane;
    }
}

#endif

/// Calls visit(lane, hit) for each triangle of a leaf that is hit with tmin < t <= tmax, until it
/// returns true. Returns whether it did.
template <TriangleTest Test, class Visit>
RT_HD inline bool visit_hits(const PreparedRay& ray, const TriangleBlock& block,
                             std::uint32_t count, float tmax, Visit&& visit) {
    PrimitiveHit hit;
    const auto intersects = [&](std::uint32_t lane) {
        return intersect_triangle<Test>(ray, block.corner(0, lane), block.corner(1, lane),
                                        block.corner(2, lane), tmax, hit);
    };
#if defined(__SSE2__) && !defined(__CUDACC__)
    if constexpr (Test == TriangleTest::watertight) {
        BlockHits hits;
        test_block(ray, block, count, tmax, hits);
        for (std::uint32_t rest = hits.hit; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
            if (visit(lane, PrimitiveHit{hits.t[lane], hits.u[lane], hits.v[lane]}))
                return true;
        }
        for (std::uint32_t rest = hits.exact; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
            if (intersects(lane) && visit(lane, hit))
                return true;
        }
        return false;
    }
#endif
    for (std::uint32_t lane = 0; lane < count; ++lane)
        if (intersects(lane) && visit(lane, hit))
            return true;
    return false;
}

} // namespace plumb
