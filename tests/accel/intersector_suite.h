/// \file  What the tests over every Intersector share: the parameters and the ways to compare.
#pragma once

#include "accel/intersector.h"
#include "tests/support/brute_force.h"
<<<<<<< HEAD
#include "tests/support/device_trees.h"
=======
#include "tests/support/hits.h"
>>>>>>> fuzz
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

/// Trees of kind sah that a device reads, on the host.
enum class DeviceTree : std::uint8_t { none, binary, compressed };

struct Config {
    AccelKind kind;
    TriangleTest test = TriangleTest::watertight;
    Isa isa = Isa::automatic;
    BuildQuality quality = BuildQuality::medium;
    DeviceTree device = DeviceTree::none;
};

inline std::string name_of(const Config& c) {
    std::string name(plumb::name_of(c.kind));
    if (c.isa != Isa::automatic)
        name += "_" + std::string(plumb::name_of(c.isa));
    if (c.quality != BuildQuality::medium)
        name += "_" + std::string(plumb::name_of(c.quality));
    if (c.device != DeviceTree::none)
        name += c.device == DeviceTree::binary ? "_device_binary" : "_device_compressed";
    return name + (c.test == TriangleTest::watertight ? "" : "MoellerTrumbore");
}
inline void PrintTo(const Config& c, std::ostream* out) { *out << name_of(c); }

inline constexpr Config naive_config{AccelKind::naive};
inline constexpr Config sah_config{AccelKind::sah};
inline constexpr Config embree_config{AccelKind::embree};

/// A test body runs once for each of these; the name of the test ends in the name of the config.
class IntersectorTest : public testing::TestWithParam<Config> {
  protected:
    [[nodiscard]] static std::unique_ptr<Intersector> build(const GeometryView& view) {
        const Config& c = GetParam();
        if (c.device == DeviceTree::binary)
            return std::make_unique<BinaryOnHost>(build_sah(view), c.test);
        if (c.device == DeviceTree::compressed)
            return std::make_unique<CompressedOnHost>(build_compressed(view), c.test);
        return make_intersector(c.kind, view, {c.test, c.quality, c.isa});
    }
};

inline std::string config_name(const testing::TestParamInfo<Config>& info) {
    return name_of(info.param);
}

<<<<<<< HEAD
/// The instruction sets that this processor has, and `automatic`.
inline std::vector<Isa> isas_here() {
    std::vector<Isa> isas{Isa::automatic};
    for (const Isa isa : {Isa::portable, Isa::avx2, Isa::avx512}) {
        try {
            (void)make_intersector(AccelKind::sah, GeometryView{},
                                   {TriangleTest::watertight, BuildQuality::medium, isa});
            isas.push_back(isa);
        } catch (const std::runtime_error&) {
            continue; // a processor without it
        }
    }
    return isas;
}

/// sah in every instruction set, in the other qualities, and as a device reads it.
=======
/// sah in every instruction set, and in the other qualities.
>>>>>>> fuzz
inline std::vector<Config> sah_configs(TriangleTest test) {
    std::vector<Config> configs;
    for (const Isa isa : isas_here())
        configs.push_back({AccelKind::sah, test, isa});
    for (const BuildQuality quality : {BuildQuality::fast, BuildQuality::high})
        configs.push_back({AccelKind::sah, test, Isa::automatic, quality});
    configs.push_back({AccelKind::sah, test, Isa::portable, BuildQuality::high});
    for (const DeviceTree device : {DeviceTree::binary, DeviceTree::compressed})
        configs.push_back({AccelKind::sah, test, Isa::automatic, BuildQuality::medium, device});
    return configs;
}

/// Without Embree.
inline std::vector<Config> own_config_list(bool moeller_trumbore) {
    std::vector<Config> configs{naive_config};
    const auto append = [&](const std::vector<Config>& more) {
        configs.insert(configs.end(), more.begin(), more.end());
    };
    append(sah_configs(TriangleTest::watertight));
    if (moeller_trumbore) {
        configs.push_back({AccelKind::naive, TriangleTest::moeller_trumbore});
        append(sah_configs(TriangleTest::moeller_trumbore));
    }
    return configs;
}

inline auto own_configs() { return testing::ValuesIn(own_config_list(true)); }
inline auto every_config() {
    std::vector<Config> configs = own_config_list(true);
    configs.push_back(embree_config);
    return testing::ValuesIn(configs);
}
inline auto watertight_configs() {
    std::vector<Config> configs = own_config_list(false);
    configs.push_back(embree_config);
    return testing::ValuesIn(configs);
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
