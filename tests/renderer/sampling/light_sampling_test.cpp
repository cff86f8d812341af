/// \file  Light sampling at the edges: behind, in the plane, on the surface, without area; point
/// lights and the environment. No sample may hold a NaN.

#include "tests/renderer/sampling/light_fixtures.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>

namespace plumb::test {
namespace {

constexpr LightSampling methods[] = {LightSampling::solid_angle, LightSampling::area};
constexpr Vec3 up{0, 0, 1};

bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// A sample either is empty or is whole: finite pdf, unit direction, finite target.
bool sound(const LightSample& s) {
    if (s.pdf == 0)
        return true;
    return s.pdf > 0 && std::isfinite(s.pdf) && finite(s.wi) &&
           std::fabs(length(s.wi) - 1) < 1e-5f && (s.infinite || finite(s.target));
}

Light facing_down(LightKind kind) {
    return flat_light(kind, {-0.6f, -0.4f, 1.5f}, {0, 1.1f, 0}, {1.4f, 0, 0});
}

TEST(FlatLights, GiveNothingToPointsBehindThem) {
    for (const LightKind kind : {LightKind::rectangle, LightKind::triangle})
        for (const LightSampling method : methods) {
            const Light light = facing_down(kind);
            const Receiver above{{0.1f, 0.2f, 2.5f}, {0, 0, -1}};
            Random random(1);
            for (int i = 0; i < 1000; ++i)
                EXPECT_EQ(sample_light<full_profile>(light, above, random.square(), method).pdf, 0);
            EXPECT_EQ(light_pdf<full_profile>(light, above, {0, 0, -1}, {0.1f, 0.2f, 1.5f}, method),
                      0);
        }
}

TEST(SphereLights, GiveNothingToTheSideThatDoesNotEmit) {
    for (const bool inside_out : {false, true})
        for (const LightSampling method : methods) {
            const Light light = sphere_light({1, 2, 3}, 0.5f, inside_out);
            const Vec3 position = inside_out ? Vec3{1, 2, 4} : Vec3{1, 2, 3.2f};
            Random random(2);
            for (int i = 0; i < 1000; ++i)
                EXPECT_EQ(
                    sample_light<full_profile>(light, {position, up}, random.square(), method).pdf,
                    0);
        }
}

/// Receivers in the plane of the light, on it, on its edges and corners and on the lines through
/// them, to within a few ulp on either side.
TEST(FlatLights, StaySoundForReceiversInTheirPlane) {
    Random random(3);
    for (const LightKind kind : {LightKind::rectangle, LightKind::triangle})
        for (const LightSampling method : methods)
            for (int i = 0; i < 20000; ++i) {
                const Vec3 e1 = random.direction();
                const Vec3 e2 = normalize(cross(e1, random.direction()));
                const Light light = flat_light(kind, random.point(-1, 1), e1, e2);
                const float places[] = {0, 1, 0.5f, -1, 2, random.uniform(-3, 3)};
                Vec3 p = light.origin + e1 * places[random.index(6)] + e2 * places[random.index(6)];
                p += light.normal * (1e-7f * static_cast<float>(random.index(5)));
                const Receiver receiver{p, light.normal};
                const LightSample s =
                    sample_light<full_profile>(light, receiver, random.square(), method);
                ASSERT_TRUE(sound(s)) << i << " pdf " << s.pdf;
                const float pdf =
                    light_pdf<full_profile>(light, receiver, normalize(e1 + e2),
                                            light.origin + 0.3f * e1 + 0.3f * e2, method);
                ASSERT_TRUE(pdf >= 0 && std::isfinite(pdf)) << i;
            }
}

TEST(SphereLights, StaySoundForReceiversOnTheirSurface) {
    Random random(4);
    for (const bool inside_out : {false, true})
        for (const LightSampling method : methods)
            for (int i = 0; i < 20000; ++i) {
                const Light light = sphere_light(random.point(-1, 1), 0.5f, inside_out);
                const float scale = 1 + 1e-7f * (static_cast<float>(random.index(9)) - 4);
                const Vec3 out = random.direction();
                const Receiver receiver{light.origin + out * (0.5f * scale), out};
                const LightSample s =
                    sample_light<full_profile>(light, receiver, random.square(), method);
                ASSERT_TRUE(sound(s)) << i << " pdf " << s.pdf;
                const float pdf = light_pdf<full_profile>(light, receiver, out,
                                                          light.origin - out * 0.5f, method);
                ASSERT_TRUE(pdf >= 0 && std::isfinite(pdf)) << i;
            }
}

/// Corners of the unit square of random numbers, for every case of the density test.
TEST(LightSampling, IsSoundAtTheCornersOfTheUnitSquare) {
    const float last = 1 - unit_roundoff;
    for (const LightCase& scene : light_cases())
        for (const LightSampling method : methods)
            for (const float x : {0.0f, unit_roundoff, 0.25f, 0.5f, last})
                for (const float y : {0.0f, unit_roundoff, 0.5f, 0.75f, last}) {
                    const LightSample s = sample_light<full_profile>(
                        scene.light, {scene.receiver, up}, {x, y}, method);
                    EXPECT_TRUE(sound(s)) << scene.name << ' ' << x << ' ' << y;
                }
}

/// Without area nothing is ever found; nothing may be NaN either.
TEST(FlatLights, WithoutAreaGiveNothing) {
    for (const LightKind kind : {LightKind::rectangle, LightKind::triangle})
        for (const LightSampling method : methods) {
            Light light = flat_light(kind, {0, 0, 1}, {1, 0, 0}, {2, 0, 0});
            light.normal = {}; // as the scene tables leave it
            light.area = 0;
            const LightSample s =
                sample_light<full_profile>(light, {{0, 0, 0}, up}, {0.3f, 0.6f}, method);
            EXPECT_EQ(s.pdf, 0);
            EXPECT_EQ(light_pdf<full_profile>(light, {{0, 0, 0}, up}, up, {0, 0, 1}, method), 0);
        }
}

/// The two methods meet at min_solid_angle; pdfs on both sides differ by the variation of the
/// area's pdf across the light only.
TEST(FlatLights, ChangeMethodAtTheThreshold) {
    for (const LightKind kind : {LightKind::rectangle, LightKind::triangle}) {
        const Light light = facing_down(kind);
        const float half = 0.5f * light.area;
        for (const float factor : {0.97f, 1.03f}) {
            const float distance = factor * std::sqrt(2 * half / min_solid_angle);
            const Receiver receiver{{0, 0, 1.5f - distance}, up};
            Random random(5);
            float low = 1e30f, high = 0;
            for (int i = 0; i < 1000; ++i) {
                const float pdf = sample_light<full_profile>(light, receiver, random.square(),
                                                             LightSampling::solid_angle)
                                      .pdf;
                low = min(low, pdf);
                high = max(high, pdf);
            }
            if (factor < 1)
                EXPECT_EQ(low, high); // one number: the solid angle's
            else
                EXPECT_LT(low, high);
            EXPECT_NEAR(high * min_solid_angle, factor * factor, 0.05);
            EXPECT_NEAR(low * min_solid_angle, factor * factor, 0.05);
        }
    }
}

TEST(PointLight, GivesIntensityOverSquaredDistance) {
    Light light;
    light.kind = LightKind::point;
    light.emission = {2, 4, 8};
    light.origin = {1, 2, 3};
    const Receiver receiver{{1, 2, 0.5f}, up};
    for (const LightSampling method : methods) {
        const LightSample s = sample_light<full_profile>(light, receiver, {0.3f, 0.4f}, method);
        EXPECT_EQ(s.wi, up);
        EXPECT_EQ(s.target, light.origin);
        EXPECT_EQ(s.pdf, 1);
        EXPECT_TRUE(s.delta);
        EXPECT_FLOAT_EQ(s.radiance.r, 2 / 6.25f);
        EXPECT_FLOAT_EQ(s.radiance.b, 8 / 6.25f);
        EXPECT_EQ(sample_light<full_profile>(light, {light.origin, up}, {0, 0}, method).pdf, 0);
    }
}

/// chi² over the hemisphere of a tilted receiver; the pdf is light_pdf's and 0 below the horizon.
TEST(Environment, IsUniformOverTheHemisphereOfTheReceiver) {
    Light light;
    light.kind = LightKind::environment;
    light.emission = {1, 2, 3};
    const Receiver receiver{{5, 6, 7}, normalize(Vec3{1, -2, 0.5f})};
    const Frame frame(receiver.normal);
    Random random(6);
    const int n = 200000;
    std::array<double, 256> counts{};
    MeanTest irradiance;
    for (int i = 0; i < n; ++i) {
        const LightSample s = sample_light<full_profile>(light, receiver, random.square(),
                                                         LightSampling::solid_angle);
        ASSERT_TRUE(sound(s));
        ASSERT_TRUE(s.infinite);
        const Vec3 local = frame.to_local(s.wi);
        if (local.z > 1e-6f) {
            ASSERT_EQ(s.pdf, light_pdf<full_profile>(light, receiver, s.wi, {},
                                                     LightSampling::solid_angle));
        }
        const int z = std::clamp(static_cast<int>(local.z * 16), 0, 15);
        const double turn = std::atan2(static_cast<double>(local.y), static_cast<double>(local.x)) /
                                (2 * pi_double) +
                            0.5;
        counts[static_cast<std::size_t>(16 * z + std::clamp(static_cast<int>(turn * 16), 0, 15))] +=
            1;
        irradiance.add(static_cast<double>(local.z) / static_cast<double>(s.pdf));
    }
    EXPECT_GT(chi_square_p_value(counts, std::vector<double>(256, n / 256.0)), p_limit);
    EXPECT_LE(std::fabs(irradiance.z(pi_double)), z_limit); // oracles.md: pi L under a sky
    EXPECT_EQ(
        light_pdf<full_profile>(light, receiver, -receiver.normal, {}, LightSampling::solid_angle),
        0);
}

} // namespace
} // namespace plumb::test
