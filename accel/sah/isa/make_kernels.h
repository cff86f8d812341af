/// \file  Fills a table of kernels from the templates. For the files of one instruction set only.
#pragma once

#include "accel/sah/isa/kernels.h"
#include "accel/sah/isa/packet_stream.h"
#include "accel/sah/isa/packet_traverse.h"
#include "accel/sah/wide_careful.h"

namespace plumb {
namespace {

/// Whether a ray is likely to do what the one before it did: of this thread's last sixteen rays
/// most started near the one before, within 1/16 of the scene. (One alone would change its mind at
/// every silhouette.) In a tiny tree a wrong guess costs less than asking.
inline bool resembles_last(const WideView& tree, const Ray& ray) {
    struct Past {
        alignas(16) float origin[4];
        std::uint32_t near; ///< a bit a ray, the last one lowest
    };
    thread_local Past past{};
    if (tree.tiny)
        return true;
    const __m128 origin = _mm_loadu_ps(&ray.origin.x);
    const __m128 step = absolute4(_mm_sub_ps(origin, _mm_load_ps(past.origin)));
    _mm_store_ps(past.origin, origin);
    const int far = _mm_movemask_ps(_mm_cmpnlt_ps(step, _mm_set1_ps(tree.reach * 0x1p-4f))) & 7;
    past.near = past.near << 1 | (far == 0 ? 1u : 0u);
    return std::popcount(past.near & 0xffffu) > 8;
}

/// For instruction sets without packets.
struct NoPackets {
    static constexpr int width = 0;
};

/// `V`: lanes of boxes and triangles, `P`: lanes of rays or NoPackets.
template <class V, class P, TriangleTest Test> struct Kernels {
    static constexpr bool has_packets = P::width > 0 && Test == TriangleTest::watertight;

    static Hit closest(const WideView& tree, const Ray& ray) {
        if (!WideRay::is_ordinary(ray, tree.reach)) [[unlikely]]
            return closest_careful(tree, ray, Test);
        if (tree.empty)
            return {};
        return resembles_last(tree, ray)
                   ? closest_ordinary<V, Test, Guess::branch>(tree, ray, NoCounter{})
                   : closest_ordinary<V, Test, Guess::select>(tree, ray, NoCounter{});
    }
    static bool occluded(const WideView& tree, const Ray& ray) {
        if (!WideRay::is_ordinary(ray, tree.reach)) [[unlikely]]
            return occluded_careful(tree, ray, Test);
        if (tree.empty)
            return false;
        return resembles_last(tree, ray)
                   ? occluded_ordinary<V, Test, Guess::branch>(tree, ray, NoCounter{})
                   : occluded_ordinary<V, Test, Guess::select>(tree, ray, NoCounter{});
    }

    static void closest_stream(const WideView& tree, std::span<const Ray> rays,
                               std::span<Hit> hits) {
        trace_stream<P>(
            tree, rays, [&](std::size_t i) { hits[i] = closest(tree, rays[i]); },
            [&](std::span<const std::uint32_t> of, auto& traversal) {
                for (std::size_t i = 0; i < of.size(); ++i)
                    hits[of[i]] = traversal.hit(i);
            });
    }
    static void occluded_stream(const WideView& tree, std::span<const Ray> rays,
                                std::span<std::uint8_t> found) {
        trace_stream<P, true>(
            tree, rays, [&](std::size_t i) { found[i] = occluded(tree, rays[i]) ? 1 : 0; },
            [&](std::span<const std::uint32_t> of, auto& traversal) {
                for (std::size_t i = 0; i < of.size(); ++i)
                    found[of[i]] = traversal.found(i) ? 1 : 0;
            });
    }

    static TraversalCounts count(const WideView& tree, std::span<const Ray> rays, bool any_hit) {
        TraversalCounts counts;
        for (const Ray& ray : rays) {
            if (tree.empty || !WideRay::is_ordinary(ray, tree.reach))
                continue;
            if (any_hit)
                occluded_ordinary<V, Test, Guess::select>(tree, ray, Counter{&counts});
            else
                closest_ordinary<V, Test, Guess::select>(tree, ray, Counter{&counts});
        }
        return counts;
    }

  private:
    /// As packets where there are any, else one by one. `one(i)` traces a ray; `take(indices,
    /// traversal)` takes the results of a packet.
    template <class Lanes, bool AnyHit = false, class One, class Take>
    static void trace_stream(const WideView& tree, std::span<const Ray> rays, One&& one,
                             Take&& take) {
        if constexpr (has_packets) {
            if (!tree.empty)
                return PacketStream<Lanes>(rays, tree.reach)
                    .for_each(
                        [&](std::span<const std::uint32_t> indices,
                            std::span<const Ray* const> part, RayPacket<Lanes>& packet) {
                            PacketTraversal<V, Lanes, AnyHit> traversal(tree, part, packet);
                            traversal.run();
                            take(indices, traversal);
                        },
                        one);
        }
        for (std::size_t i = 0; i < rays.size(); ++i)
            one(i);
    }
};

template <class V, class P, TriangleTest Test> WideKernels kernels_with() {
    using K = Kernels<V, P, Test>;
    return {K::closest, K::occluded, K::closest_stream, K::occluded_stream, K::count};
}

template <class V, class P> WideKernels make_kernels(TriangleTest test) {
    return test == TriangleTest::moeller_trumbore
               ? kernels_with<V, P, TriangleTest::moeller_trumbore>()
               : kernels_with<V, P, TriangleTest::watertight>();
}

} // namespace
} // namespace plumb
