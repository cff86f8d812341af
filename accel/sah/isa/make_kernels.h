/// \file  Fills a table of kernels from the templates. For the files of one instruction set only.
#pragma once

#include "accel/sah/isa/interleaved.h"
#include "accel/sah/isa/kernels.h"
#include "accel/sah/isa/leaf_queues.h"
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

/// `V`: lanes of boxes and triangles, `P`: lanes of rays or NoPackets.
template <class V, class P, TriangleTest Test> struct Kernels {
    static Hit closest(const WideView& tree, const Ray& ray) {
        if (!WideRay::is_ordinary(ray, tree.reach)) [[unlikely]]
            return closest_careful(tree, ray, Test);
        if (tree.empty)
            return {};
        const NumberedHit best =
            resembles_last(tree, ray)
                ? closest_ordinary<V, Test, Guess::branch>(tree, ray, NoCounter{})
                : closest_ordinary<V, Test, Guess::select>(tree, ray, NoCounter{});
        return best.with_ids(tree);
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
        trace_stream<false>(
            tree, rays, [&](std::size_t i) { hits[i] = closest_careful(tree, rays[i], Test); },
            [&](std::size_t i, const NumberedHit& best) { hits[i] = best.with_ids(tree); });
    }
    static void occluded_stream(const WideView& tree, std::span<const Ray> rays,
                                std::span<std::uint8_t> found) {
        trace_stream<true>(
            tree, rays,
            [&](std::size_t i) { found[i] = occluded_careful(tree, rays[i], Test) ? 1 : 0; },
            [&](std::size_t i, const NumberedHit& best) {
                found[i] = best.number != invalid_id ? 1 : 0;
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
    using Packets = std::conditional_t<Test == TriangleTest::watertight, P, NoPackets>;

    /// As packets where rays run alike, else by themselves (trace_alone).
    /// `careful(i)` traces a ray that is not ordinary, take(i, hit) gets what the others found.
    template <bool AnyHit, class Careful, class Take>
    static void trace_stream(const WideView& tree, std::span<const Ray> rays, Careful&& careful,
                             Take&& take) {
        if (tree.empty) {
            for (std::size_t i = 0; i < rays.size(); ++i)
                careful(i);
            return;
        }
        PacketStream<Packets>(rays, tree.reach)
            .for_each(
                [&]<class Lanes>(const PacketRays& part, RayPacket<Lanes>& packet) {
                    PacketTraversal<V, Lanes, AnyHit> traversal(tree, part, packet);
                    traversal.run();
                    if constexpr (AnyHit) {
                        const unsigned found = traversal.found();
                        for (std::size_t i = 0; i < part.indices.size(); ++i)
                            take(part.indices[i],
                                 NumberedHit(0, 0, 0, (found >> i & 1u) - 1)); // 0 or invalid_id
                    } else {
                        for (std::size_t i = 0; i < part.indices.size(); ++i)
                            take(part.indices[i], traversal.best(i));
                    }
                },
                [&](RayIndices indices) {
                    trace_alone<AnyHit>(tree, rays, indices, careful, take);
                });
    }

    /// What an ordinary ray finds; of AnyHit only whether its number is valid.
    template <bool AnyHit> static NumberedHit find_one(const WideView& tree, const Ray& ray) {
        if constexpr (!AnyHit)
            return closest_ordinary<V, Test, Guess::branch>(tree, ray, NoCounter{});
        NumberedHit best(ray.tmax);
        if (occluded_ordinary<V, Test, Guess::branch>(tree, ray, NoCounter{}))
            best.number = 0;
        return best;
    }

    /// Before the leaves of a tree of one level, interleaved or, in other tiny trees, one by one.
    template <bool AnyHit, class Careful, class Take>
    static void trace_alone(const WideView& tree, std::span<const Ray> rays, RayIndices indices,
                            Careful&& careful, Take&& take) {
        std::size_t i = 0;
        const auto next = [&](std::uint32_t& index) -> const Ray* {
            while (i < indices.size()) {
                index = indices[i++];
                if (WideRay::is_ordinary(rays[index], tree.reach)) [[likely]]
                    return &rays[index];
                careful(index);
            }
            return nullptr;
        };
        if constexpr (Packets::width > 0)
            if (tree.one_level) {
                LeafQueues<V, Packets, AnyHit>::of_this_thread().run(
                    tree, rays.data(), next,
                    [&](std::uint32_t index) { take(index, find_one<AnyHit>(tree, rays[index])); },
                    take);
                return;
            }
        if (tree.tiny) { // in the cache, and guessed well
            std::uint32_t index = 0;
            while (const Ray* ray = next(index))
                take(index, find_one<AnyHit>(tree, *ray));
        } else {
            Interleaved<V, Test, AnyHit>::of_this_thread().run(
                tree, next, [&](const auto& ray) { take(ray.index(), ray.best()); });
        }
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
