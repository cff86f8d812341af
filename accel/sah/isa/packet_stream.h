/// \file  Sorts the rays of a stream into packets.
#pragma once

#include "accel/sah/isa/ray_packet.h"

#include <array>

namespace plumb {
namespace {

/// Rays that follow each other are tried as a packet first. Those that do not run alike wait, by
/// the signs and the largest axis of their directions, until a packet of them is full.
template <class P> class PacketStream {
  public:
    PacketStream(std::span<const Ray> rays, float reach) : rays_(rays), reach_(reach) {}

    /// Calls many(indices, rays, packet) for packets and one(index) for other rays.
    template <class Many, class One> void for_each(Many&& many, One&& one) {
        for (std::size_t begin = 0; begin < rays_.size(); begin += width) {
            Group group;
            for (std::size_t i = begin; i < std::min(begin + width, rays_.size()); ++i)
                group.indices[group.size++] = static_cast<std::uint32_t>(i);
            if (trace(group, many))
                continue;
            for (std::size_t i = begin; i < begin + group.size; ++i) {
                Group& waiting = waiting_[kind_of(rays_[i])];
                waiting.indices[waiting.size++] = static_cast<std::uint32_t>(i);
                if (waiting.size == width)
                    finish(waiting, many, one);
            }
        }
        for (Group& waiting : waiting_)
            finish(waiting, many, one);
    }

  private:
    static constexpr std::size_t width = P::width;
    /// Fewer rays are not worth a packet.
    static constexpr std::size_t least = width / 4;

    struct Group {
        std::uint32_t size = 0;
        std::uint32_t indices[width];
    };

    /// Signs and largest axis, as one number below 32.
    static std::size_t kind_of(const Ray& ray) {
        const Vec3 d = ray.direction, length = abs(d);
        const std::size_t signs = (std::signbit(d.x) ? 1u : 0u) | (std::signbit(d.y) ? 2u : 0u) |
                                  (std::signbit(d.z) ? 4u : 0u);
        const bool x = length.x > length.y && length.x > length.z;
        return signs | (x ? 0u : length.y > length.z ? 8u : 16u);
    }

    /// Whether the rays run alike and were traced.
    template <class Many> bool trace(const Group& group, Many&& many) {
        if (group.size < least)
            return false;
        const Ray* part[width];
        for (std::size_t i = 0; i < group.size; ++i)
            part[i] = &rays_[group.indices[i]];
        const std::span<const Ray* const> there(part, group.size);
        RayPacket<P> packet(there, reach_);
        if (packet.alike)
            many(std::span<const std::uint32_t>(group.indices, group.size), there, packet);
        return packet.alike;
    }

    template <class Many, class One> void finish(Group& group, Many&& many, One&& one) {
        if (!trace(group, many))
            for (std::size_t i = 0; i < group.size; ++i)
                one(group.indices[i]);
        group.size = 0;
    }

    std::span<const Ray> rays_;
    float reach_;
    std::array<Group, 24> waiting_;
};

} // namespace
} // namespace plumb
