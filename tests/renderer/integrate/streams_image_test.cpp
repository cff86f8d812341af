/// \file  Streams of rays against one ray at a time: the same bits in every setting.

#include "tests/support/box_scenes.h"
#include "tests/support/interruption.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_text.h"

#include "renderer/integrate/path_lanes.h"
#include "renderer/scene/scene_tables.h"

#include <atomic>
#include <cstring>
#include <gtest/gtest.h>
#include <map>
#include <tuple>

namespace plumb::test {
namespace {

/// One way to render a scene.
struct Setting {
    const char* name;
    void (*adjust)(Scene&);
};

constexpr Setting settings[] = {
    {"as_it_is", [](Scene&) {}},
    {"light_estimator", [](Scene& s) { s.path.estimator = Estimator::light; }},
    {"bsdf_estimator", [](Scene& s) { s.path.estimator = Estimator::bsdf; }},
    {"uniform_hemisphere", [](Scene& s) { s.path.hemisphere = HemisphereSampling::uniform; }},
    {"light_area", [](Scene& s) { s.path.light_sampling = LightSampling::area; }},
    {"early_roulette", [](Scene& s) { s.path.rr_depth = 1; }},
    {"constant_roulette",
     [](Scene& s) {
         s.path.roulette = RouletteKind::constant;
         s.path.rr_depth = 2;
     }},
    {"no_roulette",
     [](Scene& s) {
         s.path.roulette = RouletteKind::none;
         s.path.max_depth = 20;
     }},
    {"emitters_only", [](Scene& s) { s.path.max_depth = 1; }},
    {"direct_light",
     [](Scene& s) {
         s.path.max_depth = 2;
         s.path.hide_emitters = true;
     }},
    {"sobol", [](Scene& s) { s.sampler.kind = SamplerKind::sobol; }},
    {"one_sample", [](Scene& s) { s.sampler.spp = 1; }},
    {"odd_samples", [](Scene& s) { s.sampler.spp = 37; }},
    {"one_pixel",
     [](Scene& s) {
         s.film.crop = {20, 11, 1, 1};
         s.sampler.spp = 700;
     }},
    {"thin_crop",
     [](Scene& s) {
         s.film.crop = {3, 6, 29, 2};
     }},
    {"gaussian", [](Scene& s) { s.film.filter.kind = FilterKind::gaussian; }},
};

class Streams : public ::testing::TestWithParam<std::tuple<bool, Setting>> {};

TEST_P(Streams, GiveTheBitsOfSingleRays) {
    const auto [rich, setting] = GetParam();
    RenderSetup setup;
    setup.variance = true;
    setup.parameters = {{"side", "40"}, {"spp", "5"}, {"seed", "3"}};
    setup.adjust = setting.adjust;
    const std::string xml = rich ? rich_box() : plain_box();
    const Rendered streams = render_xml(xml, setup);
    setup.ray_by_ray = true;
    const Rendered single = render_xml(xml, setup);
    EXPECT_EQ(bits_of(streams.image), bits_of(single.image));
    ASSERT_EQ(streams.image.variance.size(), single.image.variance.size());
    EXPECT_EQ(std::memcmp(streams.image.variance.data(), single.image.variance.data(),
                          single.image.variance.size() * sizeof(Rgb)),
              0);
    EXPECT_EQ(streams.stats.rays.camera, single.stats.rays.camera);
    EXPECT_EQ(streams.stats.rays.bounce, single.stats.rays.bounce);
    EXPECT_EQ(streams.stats.rays.shadow, single.stats.rays.shadow);
    EXPECT_GT(streams.stats.rays.camera, 0u);
}

INSTANTIATE_TEST_SUITE_P(Image, Streams,
                         ::testing::Combine(::testing::Bool(), ::testing::ValuesIn(settings)),
                         [](const auto& tested) {
                             return std::string(std::get<0>(tested.param) ? "rich_" : "plain_") +
                                    std::get<1>(tested.param).name;
                         });

/// Where a loop over lanes leaves single lanes to the general code.
void expect_same_bits(const std::string& xml) {
    RenderSetup setup;
    setup.parameters = {{"side", "16"}, {"spp", "32"}};
    const Rendered streams = render_xml(xml, setup);
    setup.ray_by_ray = true;
    const Rendered single = render_xml(xml, setup);
    EXPECT_EQ(streams.stats.profile, "box");
    EXPECT_GT(streams.stats.rays.shadow, 1000u);
    EXPECT_EQ(bits_of(streams.image), bits_of(single.image));
}

TEST(StreamsImage, ALampThatNeedsDoubleHasTheBitsOfSingleRays) {
    // A floor that comes as close to the lamp's plane as 1e-4 of its size.
    expect_same_bits(scene_text(
        camera_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 40),
        rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, diffuse({1, 1, 1})) +
            rectangle({0, 0.5, 1e-4}, {-0.5, 0, 0}, {0, 0.5, 0}, black_emitter({1, 1, 1}))));
}

TEST(StreamsImage, SliversHaveTheBitsOfSingleRays) {
    // Triangles of 2e-12 x 2e-12: the square of their cross product is zero.
    expect_same_bits(scene_text(
        camera_at({0, 0, 3e-12}, {0, 0, 0}, {0, 1, 0}, 40, "") +
            R"(<float name="near_clip" value="1e-14"/>)",
        R"(<shape type="rectangle"><transform name="to_world"><scale value="1e-12"/></transform>)" +
            diffuse({0.5, 0.6, 0.7}) +
            R"(</shape><shape type="rectangle"><transform name="to_world">)"
            R"(<rotate x="1" angle="180"/><translate z="4"/></transform>)" +
            area_emitter({1, 1, 1}) + "</shape>"));
}

/// The pixels of a tile that is left early have different numbers of samples, each the first ones.
TEST(StreamsImage, CancelledInATileItKeepsWholeSamples) {
    Scene scene;
    RenderSetup setup;
    setup.parameters = {{"side", "16"}, {"spp", "64"}};
    setup.adjust = [&scene](Scene& loaded) { scene = loaded; };
    static_cast<void>(render_xml(plain_box(), setup));
    const SceneTables tables(scene);
    const auto sah = make_intersector(AccelKind::sah, tables.geometry());
    std::atomic<bool> cancel{false};
    const Interruption interruption(*sah, 100, cancel);
    RenderOptions how;
    how.threads = 1;
    how.cancel = &cancel;
    RenderStats stats;
    RenderJob job = make_job(scene, tables.view());
    const Features needed = features_of(scene);
    Film film = render(job, needed, interruption, how, stats);
    EXPECT_EQ(interruption.longest(), max_lanes) << "camera rays come in whole streams";
    EXPECT_LT(stats.samples, 16u * 16 * 64);
    std::map<std::uint32_t, Film> films; // by samples a pixel
    how.cancel = nullptr;
    std::uint64_t samples = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            const FilmPixel& pixel = film.pixel(x, y);
            samples += pixel.count;
            if (pixel.count == 0)
                continue;
            job.sampler.spp = pixel.count;
            RenderStats ignored;
            auto found = films.find(pixel.count);
            if (found == films.end())
                found = films.emplace(pixel.count, render(job, needed, *sah, how, ignored)).first;
            for (int c = 0; c < 3; ++c)
                EXPECT_EQ(pixel.sum[c], found->second.pixel(x, y).sum[c]) << x << ' ' << y;
        }
    EXPECT_EQ(samples, stats.samples);
    EXPECT_EQ(films.count(64), 1u) << "some pixels are done";
    EXPECT_LT(samples, 16u * 16 * 64) << "others are not";
}

} // namespace
} // namespace plumb::test
