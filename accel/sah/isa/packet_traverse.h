/// \file  Packets of rays through the 8-wide tree, for coherent streams.
///
/// A node is tested against the hull of the packet (all eight children at once), a child's box
/// against each ray (all rays at once) when the child's turn comes, so a box costs a packet little
/// more than a ray. Coherent packets do what the one before did: the next child is found by jumps
/// (Guess::branch), so that it is on its way before the boxes are tested. Where few rays are left
/// in a box they go on one by one: S. Woop et al., "Embree", SIGGRAPH 2014, calls that hybrid
/// traversal; the hull is that of W. Reshetov, A. Soupikov, J. Hurley, "Multi-Level Ray Tracing
/// Algorithm", SIGGRAPH 2005, as intervals. Same hits as ray by ray: the tests are conservative,
/// the triangle test is the same.
#pragma once

#include "accel/sah/isa/packet_triangles.h"
#include "accel/sah/isa/wide_traverse.h"

namespace plumb {
namespace {

/// Rays in a box from which on they are traced together.
inline constexpr int packet_min_in_node = 2, packet_min_in_leaf = 4;

/// A child that waits: its key (see StackEntry), and its planes in the node above, of which the
/// next are 8 floats on. Null for the root.
struct PacketEntry {
    StackEntry key;
    const float* planes;
};

/// The rays that enter a box at or before their best t.
template <class P>
[[gnu::always_inline]] inline unsigned rays_in_box(const RayPacket<P>& packet,
                                                   const float* planes) {
    using Floats = typename P::Floats;
    Floats near = P::load(packet.tmin), far = P::load(packet.best_t);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t down = packet.negative >> axis & 1u;
        const Floats enter = P::broadcast(planes[wide_width * (2 * axis + down)]);
        const Floats leave = P::broadcast(planes[wide_width * (2 * axis + 1 - down)]);
        near = P::max(P::multiply_add(enter, P::load(packet.near_inverse[axis]),
                                      P::load(packet.near_addend[axis])),
                      near);
        far = P::min(P::multiply_add(leave, P::load(packet.far_inverse[axis]),
                                     P::load(packet.far_addend[axis])),
                     far);
    }
    return P::bits(P::not_greater(near, far));
}

/// One packet on its way. `AnyHit`: rays leave it at their first hit.
template <class V, class P, bool AnyHit> class PacketTraversal {
  public:
    PacketTraversal(const WideView& tree, const PacketRays& rays, RayPacket<P>& packet)
        : tree_(tree), rays_(rays), packet_(packet), test_(PacketHull<P>(packet)) {
        find_farthest();
    }

    void run() {
        PacketEntry entry{stack_entry(WideRef{}, 0), nullptr};
        for (;;) {
            const unsigned active =
                entry.planes != nullptr ? rays_in_box(packet_, entry.planes) : all_rays;
            const WideRef ref = ref_of(entry.key);
            const int count = std::popcount(active);
            if (count < (ref.is_leaf() ? packet_min_in_leaf : packet_min_in_node) ||
                (ref.is_leaf() && ref.has_spheres())) {
                go_on_alone(active, ref);
            } else if (ref.is_leaf()) {
                visit(active, tree_.at<WideTriangles>(ref));
            } else {
                const auto& node = tree_.at<WideNode>(ref);
                typename V::Floats near;
                const unsigned mask = test_(node, V::broadcast(farthest_), near);
                if (mask != 0) {
                    entry = enter(node, mask, near);
                    continue;
                }
            }
            do {
                if (size_ == 0)
                    return;
                entry = stack_[--size_];
            } while (near_of(entry.key) > farthest_);
        }
    }

    /// AnyHit: a bit for each ray that has a hit.
    [[nodiscard]] unsigned found() const {
        return all_rays & ~P::bits(P::not_greater(P::broadcast(0), P::load(packet_.best_t)));
    }
    /// Not AnyHit: what a ray found.
    [[nodiscard]] NumberedHit best(std::size_t ray) const {
        return best_.at(ray, packet_.best_t[ray]);
    }

  private:
    static constexpr unsigned all_rays = (1u << P::width) - 1;

    void find_farthest() { farthest_ = P::largest(P::load(packet_.best_t)); }

    /// Pushes all children in `mask` (at least one) but the nearest, farthest first, and returns
    /// the nearest.
    [[gnu::always_inline]] PacketEntry enter(const WideNode& node, unsigned mask,
                                             typename V::Floats near) {
        const auto take = [&] {
            const auto lane = static_cast<unsigned>(std::countr_zero(mask));
            mask &= mask - 1;
            return lane;
        };
        const unsigned first = take();
        if (mask == 0)
            return jump_to(node, first);
        alignas(32) float distance[wide_width];
        V::store(distance, near);
        const auto entry = [&](unsigned lane) {
            return PacketEntry{stack_entry(node.child[lane], distance[lane]),
                               &node.planes[0][0][lane]};
        };
        const unsigned second = take();
        if (mask == 0) {
            if (distance[second] < distance[first]) {
                stack_[size_++] = entry(first);
                return jump_to(node, second);
            }
            stack_[size_++] = entry(second);
            return jump_to(node, first);
        }
        const int base = size_;
        stack_[size_++] = entry(first);
        for (unsigned lane = second;; lane = take()) { // insertion
            const PacketEntry one = entry(lane);
            int i = size_++;
            for (; i > base && stack_[i - 1].key < one.key; --i)
                stack_[i] = stack_[i - 1];
            stack_[i] = one;
            if (mask == 0)
                break;
        }
        const PacketEntry nearest = stack_[--size_];
        return jump_to(node, static_cast<unsigned>(nearest.planes - &node.planes[0][0][0]));
    }
    static PacketEntry jump_to(const WideNode& node, unsigned lane) {
        return by_jump(lane, [&node](unsigned i) {
            return PacketEntry{stack_entry(node.child[i], 0), &node.planes[0][0][i]};
        });
    }

    void go_on_alone(unsigned active, WideRef ref) {
        for (; active != 0; active &= active - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(active));
            WideRay& ray = alone(i);
            if constexpr (AnyHit) {
                if (find_any<V, TriangleTest::watertight, Guess::branch>(tree_, ray, ref,
                                                                         NoCounter{}))
                    take_out(i);
            } else {
                NumberedHit closer = best(i);
                find_closest<V, TriangleTest::watertight, Guess::branch>(tree_, ray, ref, closer,
                                                                         NoCounter{});
                keep(i, closer);
            }
        }
        find_farthest();
    }

    void visit(unsigned active, const WideTriangles& block) {
        alignas(64) float planes[6 * wide_width];
        store_bounds<V>(block, planes);
        typename V::Floats near;
        unsigned touched = test_(planes, V::broadcast(farthest_), near);
        for (; touched != 0; touched &= touched - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(touched));
            if (lane > 0 && block.number[lane] == block.number[lane - 1])
                break; // filled up
            PacketHits<P> hits;
            test_packet_watertight<P>(packet_, block, lane, P::mask(active), hits);
            if (P::bits(hits.hit) != 0)
                keep(hits, block.number[lane]);
            for (unsigned rest = P::bits(hits.exact); rest != 0; rest &= rest - 1)
                visit_exactly(static_cast<std::size_t>(std::countr_zero(rest)), block, lane);
        }
        find_farthest();
    }

    void visit_exactly(std::size_t i, const WideTriangles& block, std::size_t lane) {
        PrimitiveHit hit;
        if (!intersect_exactly<TriangleTest::watertight>(
                PreparedRay(rays_[i]), block, static_cast<int>(lane), packet_.best_t[i], hit))
            return;
        NumberedHit closer = best(i);
        closer.keep_closer(hit, block.number[lane]);
        keep(i, closer);
        if constexpr (AnyHit)
            take_out(i);
    }

    void keep(const PacketHits<P>& hits, PrimitiveNumber number) {
        if constexpr (AnyHit)
            P::store_where(packet_.best_t, hits.hit, P::broadcast(-1)); // see take_out
        else
            best_.keep(packet_.best_t, hits, number);
    }
    void keep(std::size_t i, const NumberedHit& hit) {
        packet_.best_t[i] = hit.t;
        best_.set(i, hit);
    }
    /// Ends a ray that found a hit: no box is entered before t = -1.
    void take_out(std::size_t i) { packet_.best_t[i] = -1; }

    /// The ray by itself, made on first use.
    WideRay& alone(std::size_t i) {
        auto* ray = reinterpret_cast<WideRay*>(alone_[i]);
        if ((made_ >> i & 1u) == 0)
            ray = new (alone_[i]) WideRay(rays_[i], tree_.reach);
        made_ |= 1u << i;
        return *ray;
    }

    const WideView& tree_;
    PacketRays rays_;
    RayPacket<P>& packet_;
    NodeTest<V> test_;
    float farthest_; ///< best t of the ray that has it farthest
    int size_ = 0;
    unsigned made_ = 0;
    PacketBest<P> best_;
    PacketEntry stack_[wide_max_stack];
    alignas(WideRay) std::byte alone_[P::width][sizeof(WideRay)];
};

} // namespace
} // namespace plumb
