/// \file  Many rays of a stream on their way at once, a step of each in turn.
///
/// A ray by itself knows what it needs next only when its last step is done: the processor waits
/// for memory and for the chain from the box test to the child, and guesses wrong what comes. Here
/// a ray's next node or leaf is fetched while others have their turn; nodes are tested after nodes
/// and leaves after leaves, with next to no jumps in between. Databases search like that: O.
/// Kocberber, B. Falsafi, B. Grot, "Asynchronous Memory Access Chaining", VLDB 2015. The tests are
/// those of single rays, so the hits are the same.
#pragma once

#include "accel/sah/isa/interleaved_ray.h"

#include <memory>
#include <new>
#include <utility>

namespace plumb {
namespace {

/// Rays on their way: enough to hide memory, few enough for the first-level cache.
inline constexpr std::size_t interleaved_rays = 24;

/// About 100 kB, too much for small stacks: of_this_thread().
template <class V, TriangleTest Test, bool AnyHit> class Interleaved {
  public:
    using Item = InterleavedRay<V, Test, AnyHit>;

    /// Made on first use; throws std::bad_alloc.
    static Interleaved& of_this_thread() {
        thread_local const std::unique_ptr<Interleaved> one(new Interleaved);
        return *one;
    }

    /// For a tree that is not empty. next(index) returns the next ray, which has to be ordinary,
    /// and its index, or null where there are no more; take(item) gets those that are done, in any
    /// order.
    template <class Next, class Take> void run(const WideView& tree, Next&& next, Take&& take) {
        tree_ = tree;
        set({}); // an exception may have left rays here
        for (Memory& place : memory_)
            if (!start(place, next))
                break;
        while (nodes_.size + triangles_.size + others_.size > 0) {
            visit_nodes();
            visit_triangle_blocks();
            const std::size_t count = std::exchange(others_.size, 0);
            for (std::size_t i = 0; i < count; ++i) {
                Item* const item = others_.item[i];
                if (item->is_done()) {
                    take(std::as_const(*item));
                    start(*reinterpret_cast<Memory*>(item), next);
                } else {
                    item->visit_sphere_block(tree_);
                    Sizes sizes = this->sizes();
                    sort(item, sizes);
                    set(sizes);
                }
            }
        }
    }

  private:
    Interleaved() = default;

    struct alignas(64) Memory {
        std::byte bytes[sizeof(Item)];
    };
    struct List {
        std::size_t size = 0;
        Item* item[interleaved_rays];
    };

    struct Sizes {
        std::size_t nodes = 0, triangles = 0, others = 0;
    };

    Sizes sizes() const { return {nodes_.size, triangles_.size, others_.size}; }
    void set(const Sizes& sizes) {
        nodes_.size = sizes.nodes;
        triangles_.size = sizes.triangles;
        others_.size = sizes.others;
    }

    template <class Next> bool start(Memory& place, Next&& next) {
        std::uint32_t index = 0;
        const Ray* ray = next(index);
        if (ray == nullptr)
            return false;
        nodes_.item[nodes_.size++] = new (&place) Item(tree_, *ray, index);
        return true;
    }

    // Functions by themselves, so that each loop has the registers to itself.
    [[gnu::noinline]] void visit_nodes() {
        step(nodes_, [this](Item& item) { item.visit_node(tree_); });
    }
    [[gnu::noinline]] void visit_triangle_blocks() {
        step(triangles_, [this](Item& item) { item.visit_triangle_block(tree_); });
    }
    template <class Visit> [[gnu::always_inline]] void step(List& list, Visit&& visit) {
        const std::size_t count = std::exchange(list.size, 0);
        Sizes sizes = this->sizes(); // in registers
        for (std::size_t i = 0; i < count; ++i) {
            Item* const item = list.item[i];
            visit(*item);
            sort(item, sizes);
        }
        set(sizes);
    }
    /// Into the list of its next step, without a jump: into all, of which one grows.
    [[gnu::always_inline]] void sort(Item* item, Sizes& sizes) {
        const std::size_t leaf = item->current().bits >> 31;
        const std::size_t other = item->current().bits >> 30 & 1u;
        nodes_.item[sizes.nodes] = item;
        triangles_.item[sizes.triangles] = item;
        others_.item[sizes.others] = item;
        sizes.nodes += 1 - leaf;
        sizes.triangles += leaf - other;
        sizes.others += other;
    }

    WideView tree_;
    List nodes_, triangles_, others_;
    Memory memory_[interleaved_rays];
};

} // namespace
} // namespace plumb
