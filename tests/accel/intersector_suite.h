/// \file  What the tests over every Intersector share: the parameters and the ways to compare.
#pragma once

#include "accel/intersector.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace plumb::test {

struct Config {
    AccelKind kind;
    TriangleTest test;
};

inline std::string name_of(const Config& c) {
    return std::string(plumb::name_of(c.kind)) +
           (c.test == TriangleTest::watertight ? "" : "MoellerTrumbore");
}
inline void PrintTo(const Config& c, std::ostream* out) { *out << name_of(c); }

inline constexpr Config naive_config{AccelKind::naive, TriangleTest::watertight};
inline constexpr Config sah_config{AccelKind::sah, TriangleTest::watertight};
inline constexpr Config embree_config{AccelKind::embree, TriangleTest::watertight};
inline constexpr Config naive_moeller{AccelKind::naive, TriangleTest::moeller_trumbore};
inline constexpr Config sah_moeller{AccelKind::sah, TriangleTest::moeller_trumbore};

/// A test body runs once for each of these; the name of the test ends in the name of the config.
class IntersectorTest : public testing::TestWithParam<Config> {
  protected:
    [[nodiscard]] static std::unique_ptr<Intersector> build(const GeometryView& view) {
        return make_intersector(GetParam().kind, view, {GetParam().test});
    }
};

inline std::string config_name(const testing::TestParamInfo<Config>& info) {
    return name_of(info.param);
}

inline auto every_config() {
    return testing::Values(naive_config, naive_moeller, sah_config, sah_moeller, embree_config);
}
/// Without Embree.
inline auto own_configs() {
    return testing::Values(naive_config, naive_moeller, sah_config, sah_moeller);
}
inline auto watertight_configs() {
    return testing::Values(naive_config, sah_config, embree_config);
}

inline bool same_bits(const Hit& a, const Hit& b) {
    return std::bit_cast<std::uint32_t>(a.t) == std::bit_cast<std::uint32_t>(b.t) &&
           std::bit_cast<std::uint32_t>(a.u) == std::bit_cast<std::uint32_t>(b.u) &&
           std::bit_cast<std::uint32_t>(a.v) == std::bit_cast<std::uint32_t>(b.v) &&
           a.geometry == b.geometry && a.primitive == b.primitive && a.instance == b.instance;
}

inline bool is_miss(const Hit& hit) { return same_bits(hit, Hit{}); }

/// Floats between a and b, for finite numbers of one sign.
inline std::int64_t ulps_between(float a, float b) {
    return std::abs(std::int64_t{std::bit_cast<std::int32_t>(a)} -
                    std::int64_t{std::bit_cast<std::int32_t>(b)});
}

/// Rays through [-1.2,1.2]^3: from outside and inside, of any length, with axis-parallel ones and
/// ones limited by tmin and tmax among them.
inline Ray random_ray(Random& random) {
    const std::uint32_t kind = random.index(8);
    const Vec3 target = random.point(-1, 1);
    Ray ray;
    ray.origin = kind < 4 ? 4.0f * random.direction() : random.point(-1.2f, 1.2f);
    ray.direction = target - ray.origin;
    if (kind == 2)
        ray.direction = normalize(ray.direction);
    if (kind == 3 || kind == 6) { // one or two zero components
        const int keep = static_cast<int>(random.index(3));
        for (int axis = 0; axis < 3; ++axis)
            if (axis != keep && (kind == 6 || axis == (keep + 1) % 3))
                ray.direction[axis] = random.index(2) == 0 ? 0.0f : -0.0f;
    }
    if (kind == 5)
        ray.direction = std::exp(random.uniform(-20, 20)) * ray.direction;
    if (kind == 7) {
        ray.tmin = random.uniform(0, 0.5f);
        ray.tmax = ray.tmin + random.uniform(0, 1);
    }
    if (length(ray.direction) == 0)
        ray.direction = {0, 0, 1};
    return ray;
}

} // namespace plumb::test
