/// \file  Which rays of a stream become packets; where this file is compiled for AVX2.
#ifdef __AVX2__
#include "accel/sah/isa/packet_lanes_avx2.h"
#include "accel/sah/isa/packet_stream.h"
#include "tests/support/random.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>
#include <vector>

namespace plumb::test {
namespace {

struct Split {
    std::size_t in_packets = 0, alone = 0;
    std::vector<std::uint32_t> seen;

    explicit Split(const std::vector<Ray>& rays) {
        const auto see = [&](RayIndices indices) {
            seen.insert(seen.end(), indices.begin(), indices.end());
            return indices.size();
        };
        PacketStream<PacketLanes>(rays, 1).for_each(
            [&](const PacketRays& part, const auto&) {
                in_packets += see(part.indices);
                for (std::size_t i = 0; i < part.indices.size(); ++i)
                    EXPECT_EQ(&part[i], &rays[part.indices[i]]);
            },
            [&](RayIndices indices) { alone += see(indices); });
        std::sort(seen.begin(), seen.end());
        std::vector<std::uint32_t> all(rays.size());
        std::iota(all.begin(), all.end(), 0u);
        EXPECT_EQ(seen, all); // each once
    }
};

/// `make(i)` for 1200 rays: more than are looked at together, and not a multiple of a packet.
template <class Make> std::vector<Ray> rays_of(Make&& make) {
    std::vector<Ray> rays;
    for (int i = 0; i < 1203; ++i)
        rays.push_back(make(i));
    return rays;
}

Vec3 pixel(int i) { return {0.01f * static_cast<float>(i % 32) - 0.155f, 0.3f, -1}; }

TEST(PacketStream, MakesPacketsOfNeighboursThatRunAlike) {
    const Split split(rays_of([](int i) { return Ray{{}, 0, pixel(i), 1}; }));
    EXPECT_GT(split.in_packets, 1100u);
}

TEST(PacketStream, GathersByKindWhatAlternates) {
    // Four kinds in turn: no neighbours are alike.
    const Split split(rays_of([](int i) {
        const Vec3 d = pixel(i / 4);
        return Ray{{}, 0, {i % 2 == 0 ? 0.2f : -0.2f, i % 4 < 2 ? d.y : -d.y, d.z}, 1};
    }));
    EXPECT_GT(split.in_packets, 1000u);
}

TEST(PacketStream, MakesPacketsOfNeighboursWhereThereAreManyKinds) {
    Random random(50);
    Vec3 towards;
    const Split split(rays_of([&](int i) {
        if (i % 16 == 0)
            towards = random.direction();
        return Ray{{}, 0, towards + random.point(-1e-4f, 1e-4f), 1};
    }));
    EXPECT_GT(split.in_packets, 1100u);
}

/// From one point: gathered by kind some would run alike, but not enough to pay.
TEST(PacketStream, LeavesRaysThatGoEverywhereAlone) {
    Random random(51);
    const Split split(rays_of([&](int) { return Ray{{}, 0, random.direction(), 1}; }));
    EXPECT_EQ(split.in_packets, 0u);
    EXPECT_EQ(split.alone, 1203u);
}

TEST(PacketStream, LeavesRaysOfOneKindThatStartFarApartAlone) {
    Random random(52);
    const Split split(rays_of([&](int i) { return Ray{random.point(-1, 1), 0, pixel(i), 1}; }));
    EXPECT_EQ(split.in_packets, 0u);
}

} // namespace
} // namespace plumb::test
#endif
