/// \file  Splits a stream into packets of rays that run alike and rays that go by themselves.
#pragma once

#include "accel/sah/isa/ray_packet.h"

#include <array>
#include <utility>

namespace plumb {
namespace {

/// For instruction sets without packets.
struct NoPackets {
    static constexpr std::size_t width = 0;
};

/// Where a sample of the rays has few kinds (signs and largest axis of the direction), or
/// neighbours of the same, rays that follow each other are tried as a packet; those that do not run
/// alike are gathered by kind and tried again.
template <class P> class PacketStream {
  public:
    PacketStream(std::span<const Ray> rays, float reach) : rays_(rays), reach_(reach) {}

    /// Calls many(rays, packet) for packets and alone(indices) for other rays, hundreds at
    /// a time where there are that many.
    template <class Many, class Alone> void for_each(Many&& many, Alone&& alone) {
        bool all_alike = false; // so far, so that nothing has to be sampled
        for (std::size_t begin = 0; begin < rays_.size(); begin += max_lone) {
            const std::size_t end = std::min(begin + max_lone, rays_.size());
            lone_count_ = 0;
            if (P::width > 0 && (all_alike || may_run_alike(begin, end))) {
                trace_neighbours(begin, end, many);
                all_alike = lone_count_ == 0;
                if (lone_count_ >= sample_size)
                    gather(many);
            } else {
                for (std::size_t i = begin; i < end; ++i)
                    lone_[lone_count_++] = static_cast<std::uint32_t>(i);
            }
            if (lone_count_ > 0)
                alone(RayIndices(lone_, lone_count_));
        }
    }

  private:
    static constexpr std::size_t group_size = P::width > 0 ? P::width : 16;
    /// Fewer rays are not worth a packet.
    static constexpr std::size_t least = group_size / 4;
    static constexpr std::size_t max_lone = 512;
    /// Of so many rays that start everywhere nine and more kinds are likely.
    static constexpr std::size_t sample_size = 16;
    static constexpr int max_kinds = 6;

    struct Group {
        std::uint32_t size = 0;
        std::uint32_t indices[group_size];
    };

    /// Signs and largest axis of a direction, as one number below 24.
    std::size_t kind_of(std::uint32_t index) const {
        const __m128 d = _mm_loadu_ps(&rays_[index].direction.x);
        return static_cast<std::size_t>((_mm_movemask_ps(d) & 7) |
                                        WideRay::largest_axis(absolute4(d)) << 3);
    }

    /// Whether the rays run alike and were traced.
    template <class Many> bool trace(const Group& group, Many&& many) {
        if constexpr (P::width > 0) {
            if (group.size < least)
                return false;
            const PacketRays rays{rays_.data(), {group.indices, group.size}};
            RayPacket<P> packet(rays, reach_);
            if (packet.alike)
                many(rays, packet);
            return packet.alike;
        }
        return false;
    }

    /// Whether packets are worth trying: a sample of the rays has few kinds, or neighbours have the
    /// same.
    bool may_run_alike(std::size_t begin, std::size_t end) const {
        std::uint32_t kinds = 0;
        std::size_t same = 0;
        for (std::size_t i = 0; i < sample_size; ++i) {
            const std::size_t at = begin + i * (end - begin) / sample_size;
            const std::size_t kind = kind_of(static_cast<std::uint32_t>(at));
            kinds |= 1u << kind;
            same +=
                kind == kind_of(static_cast<std::uint32_t>(std::min(at + 1, end - 1))) ? 1u : 0u;
        }
        return std::popcount(kinds) <= max_kinds || 2 * same > sample_size;
    }
    /// Rays that are read soon: memory, not the arithmetic, would set the pace in small trees.
    /// Beyond the end it does nothing; to look whether that is there would take 10 % of the time.
    void prefetch(std::size_t first) const {
        const auto lines = reinterpret_cast<std::uintptr_t>(rays_.data()) + first * sizeof(Ray);
        for (std::size_t i = 0; i < group_size * sizeof(Ray); i += 64)
            _mm_prefetch(reinterpret_cast<const char*>(lines + i), _MM_HINT_T0);
    }
    template <class Many> void trace_neighbours(std::size_t begin, std::size_t end, Many&& many) {
        for (std::size_t first = begin; first < end; first += group_size) {
            Group group;
            prefetch(first + 8 * group_size);
            for (std::size_t i = first; i < std::min(first + group_size, end); ++i)
                group.indices[group.size++] = static_cast<std::uint32_t>(i);
            if (!trace(group, many))
                leave_alone(group);
        }
    }
    /// The lone rays by kind; those that run alike are traced.
    template <class Many> void gather(Many&& many) {
        std::array<Group, 24> waiting;
        const std::size_t count = std::exchange(lone_count_, 0);
        int patience = 2;
        const auto finish = [&](Group& group) {
            const bool traced = patience > 0 && trace(group, many);
            patience += traced ? 1 : -1;
            if (!traced)
                leave_alone(group); // never more than were read
            group.size = 0;
        };
        for (std::size_t i = 0; i < count; ++i) {
            Group& group = waiting[kind_of(lone_[i])];
            group.indices[group.size++] = lone_[i];
            if (group.size == group_size)
                finish(group);
        }
        for (Group& group : waiting)
            finish(group);
    }
    void leave_alone(const Group& group) {
        for (std::size_t i = 0; i < group.size; ++i)
            lone_[lone_count_++] = group.indices[i];
    }

    std::span<const Ray> rays_;
    float reach_;
    std::size_t lone_count_ = 0;
    std::uint32_t lone_[max_lone];
};

} // namespace
} // namespace plumb
