/// \file  Rays that go each its own way through a tree of a root and leaves of triangles.
///
/// In so small a tree many rays of a stream enter the same leaf, whichever way they come: they wait
/// before it until a packet is full, and each of its triangles is tested against all of them at
/// once. So few lanes are empty, and no ray waits for the results of another. The test is that of
/// packets, so the hits are the same. Queues of rays before parts of a scene: M. Pharr et al.,
/// "Rendering Complex Scenes with Memory-Coherent Ray Tracing", SIGGRAPH 1997.
#pragma once

#include "accel/sah/isa/packet_triangles.h"
#include "accel/sah/isa/wide_traverse.h"

#include <algorithm>
#include <memory>

namespace plumb {
namespace {

/// Queues before the leaves of a tree that has one level; an axis each, since the rays of a packet
/// share kz. About 90 kB, too much for small stacks: of_this_thread().
template <class V, class P, bool AnyHit> class LeafQueues {
  public:
    /// Made on first use; throws std::bad_alloc.
    static LeafQueues& of_this_thread() {
        thread_local const std::unique_ptr<LeafQueues> one(new LeafQueues);
        return *one;
    }

    /// next(index) returns the next ray of `stream`, which has to be ordinary, and sets its index,
    /// or null where there are no more; alone(index) traces one that is next to parallel to a
    /// plane; take(index, hit) gets what the others find.
    template <class Next, class Alone, class Take>
    void run(const WideView& tree, const Ray* stream, Next&& next, Alone&& alone, Take&& take) {
        std::fill(std::begin(size_), std::end(size_), 0u); // an exception may have left rays here
        const auto& root = tree.at<WideNode>(WideRef{});
        for (;;) {
            std::uint32_t count = 0, index = 0;
            const Ray* ray = nullptr;
            while (count < max_rays && (ray = next(index)) != nullptr) {
                const WideRay wide(*ray, tree.reach);
                if (wide.tilted) [[unlikely]]
                    alone(index);
                else
                    start(root, wide, index, count++);
            }
            if (count == 0)
                return;
            for (std::size_t queue = fullest(); size_[queue] > 0; queue = fullest())
                visit(tree.at<WideTriangles>(root.child[queue / 3]), queue, stream);
            for (std::uint32_t i = 0; i < count; ++i)
                take(item_[i].index, item_[i].best());
        }
    }

  private:
    /// On their way at once: more fill more packets, fewer stay in the cache.
    static constexpr std::size_t max_rays = 512;
    static constexpr std::size_t queues = 3 * wide_width; ///< leaf by leaf, in each kz by kz

    /// A ray between two leaves.
    struct alignas(64) Item {
        // Two rows for P::transpose.
        float origin[3], tmin, inverse[3], t; ///< t: tmax, then of the closest hit
        float shear[3], u, v;
        PrimitiveNumber number;
        std::uint32_t index; ///< in the stream
        std::uint32_t kz;
        /// Nearest leaf first (V::store_keys); leaves that are not entered, or were, are NaN.
        alignas(32) std::uint32_t keys[wide_width];

        [[nodiscard]] NumberedHit best() const { return {t, u, v, number}; }
    };
    static_assert(sizeof(Item) == 128);

    /// As test_packet_watertight needs it. Where there are fewer rays, the first is repeated.
    struct Packet {
        alignas(64) float origin[3][P::width], inverse[3][P::width], shear[3][P::width];
        alignas(64) float tmin[P::width], best_t[P::width];
        int kx, ky, kz;
    };

    LeafQueues() = default;

    [[gnu::always_inline]] void start(const WideNode& root, const WideRay& wide,
                                      std::uint32_t index, std::uint32_t i) {
        Item& item = item_[i];
        for (int axis = 0; axis < 3; ++axis) {
            item.origin[axis] = wide.origin[axis];
            item.inverse[axis] = wide.inverse[axis];
            item.shear[axis] = wide.shear[axis];
        }
        item.tmin = wide.tmin;
        item.t = wide.tmax;
        item.number = invalid_id;
        item.index = index;
        item.kz = static_cast<std::uint32_t>(wide.kz);
        typename V::Floats near;
        const unsigned entered = NodeTest<V>(wide)(root, V::broadcast(wide.tmax), near);
        V::store_keys(item.keys, near, entered);
        wait(i);
    }

    /// Puts a ray before the nearest leaf that is left, if that may hold a closer hit.
    [[gnu::always_inline]] void wait(std::uint32_t i) {
        Item& item = item_[i];
        const std::uint32_t key = V::take_least(item.keys);
        const std::size_t queue = 3 * (key & V::lane_bits) + item.kz;
        waiting_[queue][size_[queue]] = static_cast<std::uint16_t>(i); // if it counts
        size_[queue] += std::bit_cast<float>(key & ~V::lane_bits) <= item.t ? 1u : 0u;
    }

    [[nodiscard]] std::size_t fullest() const {
        return static_cast<std::size_t>(std::max_element(std::begin(size_), std::end(size_)) -
                                        std::begin(size_));
    }

    /// The last rays of a queue meet its leaf, and go on.
    void visit(const WideTriangles& block, std::size_t queue, const Ray* stream) {
        const std::uint32_t count = std::min<std::uint32_t>(size_[queue], P::width);
        size_[queue] -= count;
        std::uint32_t ray[P::width];
        for (std::uint32_t i = 0; i < P::width; ++i)
            ray[i] = waiting_[queue][size_[queue] + (i < count ? i : 0)];
        Packet packet;
        gather(ray, static_cast<int>(queue % 3), packet);
        PacketBest<P> best;
        unsigned active = (1u << count) - 1, changed = 0;
        for (std::size_t lane = 0; lane < wide_width && active != 0; ++lane) {
            if (lane > 0 && block.number[lane] == block.number[lane - 1])
                break; // filled up
            PacketHits<P> hits;
            test_packet_watertight<P>(packet, block, lane, P::mask(active), hits);
            if (const unsigned hit = P::bits(hits.hit); hit != 0) {
                best.keep(packet.best_t, hits, block.number[lane]);
                changed |= hit;
            }
            for (unsigned rest = P::bits(hits.exact); rest != 0; rest &= rest - 1) {
                const auto i = static_cast<std::size_t>(std::countr_zero(rest));
                if (hits_exactly(stream[item_[ray[i]].index], block, lane, i, packet, best))
                    changed |= 1u << i;
            }
            if constexpr (AnyHit)
                active &= ~changed;
        }
        for (; changed != 0; changed &= changed - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(changed));
            keep(item_[ray[i]], best.at(i, packet.best_t[i]));
        }
        for (std::uint32_t i = 0; i < count; ++i)
            wait(ray[i]);
    }

    /// As NumberedHit::keep_closer does, for a hit that is not farther.
    static void keep(Item& item, const NumberedHit& hit) {
        if (hit.t == item.t && hit.number > item.number)
            return;
        item.t = AnyHit ? -1 : hit.t; // all leaves are farther
        item.u = hit.u;
        item.v = hit.v;
        item.number = hit.number;
    }

    [[gnu::always_inline]] void gather(const std::uint32_t (&ray)[P::width], int kz,
                                       Packet& packet) const {
        typename P::Floats first[8], second[8];
        P::transpose([&](int i) { return item_[ray[i]].origin; }, first);
        P::transpose([&](int i) { return item_[ray[i]].shear; }, second);
        for (int axis = 0; axis < 3; ++axis) {
            P::store(packet.origin[axis], first[axis]);
            P::store(packet.inverse[axis], first[4 + axis]);
            P::store(packet.shear[axis], second[axis]);
        }
        P::store(packet.tmin, first[3]);
        P::store(packet.best_t, first[7]);
        packet.kz = kz;
        packet.kx = kz == 2 ? 0 : kz + 1;
        packet.ky = packet.kx == 2 ? 0 : packet.kx + 1;
    }

    /// The scalar test, for ray i of the packet. Keeps the hit.
    [[gnu::noinline]] static bool hits_exactly(const Ray& ray, const WideTriangles& block,
                                               std::size_t lane, std::size_t i, Packet& packet,
                                               PacketBest<P>& best) {
        PrimitiveHit hit;
        if (!intersect_exactly<TriangleTest::watertight>(
                PreparedRay(ray), block, static_cast<int>(lane), packet.best_t[i], hit))
            return false;
        NumberedHit closer = best.at(i, packet.best_t[i]);
        closer.keep_closer(hit, block.number[lane]);
        packet.best_t[i] = closer.t;
        best.set(i, closer);
        return true;
    }

    std::uint32_t size_[queues] = {};
    std::uint16_t waiting_[queues][max_rays + 1]; ///< numbers of items
    Item item_[max_rays];
};

} // namespace
} // namespace plumb
