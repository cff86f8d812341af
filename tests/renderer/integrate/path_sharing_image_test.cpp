/// \file  Blocks of pixels that share paths: every pixel keeps its mean, with less error.

#include "tests/support/box_scenes.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_text.h"
#include "tests/support/statistics.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace plumb::test {
namespace {

struct Variant {
    std::string name;
    std::function<std::string()> xml;
    std::function<void(Scene&)> adjust = [](Scene&) {};
    bool full_profile = false;
    SceneFileTexts files = {};
};

const std::string lamp =
    rectangle({0.4, 1.5, 0}, {0.3, 0, 0}, {0, 0, 0.3}, area_emitter({9, 8, 7}));

/// A floor and walls with shading normals far from their own, and a ball: what a vertex reflects
/// depends on whence it is seen, and directions that its cosine draws are thrown away.
std::string tilted_room() {
    return scene_text(
        camera_at({0, 1.2, 4}, {0, 0, 0}, {0, 1, 0}, 40),
        shape("obj", "",
              R"(<string name="filename" value="room.obj"/>)" + twosided({0.8, 0.6, 0.7})) +
            sphere({0.1, -0.5, 0.2}, 0.4, diffuse({0.8, 0.7, 0.6})) + lamp);
}
const SceneFileTexts tilted_files{{"room.obj", R"(v -1 -1 -1
v 1 -1 -1
v 1 -1 1
v -1 -1 1
v -1 1 -1
v 1 1 -1
vn 0.7 0.5 0.5
vn -0.7 0.6 0.4
vn -0.5 0.5 -0.7
vn 0.6 0.4 -0.7
f 4//1 3//2 2//3
f 4//1 2//3 1//4
f 1//2 2//1 6//4
f 1//2 6//4 5//1
)"}};

/// Stripes of white and black, which sends no path on.
std::string striped_room() {
    std::string stripes;
    for (int i = 0; i < 14; ++i)
        stripes += rectangle({-1.3 + 0.2 * i, -1, 0}, {0.1, 0, 0}, {0, 0, -1.4},
                             i % 2 == 0 ? diffuse({0.9, 0.8, 0.7}) : diffuse({0, 0, 0}));
    return scene_text(
        camera_at({0, 0.7, 3}, {0, -0.3, 0}, {0, 1, 0}, 50),
        stripes + rectangle({0, 0, -1}, {1.4, 0, 0}, {0, 1, 0}, diffuse({0.8, 0.8, 0.8})) + lamp);
}

std::vector<Variant> variants() {
    const auto roulette_at_once = [](Scene& scene) {
        scene.path.roulette = RouletteKind::constant;
        scene.path.roulette_constant = 0.6f;
        scene.path.rr_depth = 1;
    };
    const auto uniform = [](Scene& scene) { scene.path.hemisphere = HemisphereSampling::uniform; };
    const auto bsdf = [](Scene& scene) { scene.path.estimator = Estimator::bsdf; };
    return {{"box", plain_box},
            {"box, general kernel", plain_box, [](Scene&) {}, true},
            {"box, roulette", plain_box, roulette_at_once},
            {"box, uniform", plain_box, uniform},
            {"box, bsdf", plain_box, bsdf},
            {"rich box", rich_box},
            {"tilted room", tilted_room, [](Scene&) {}, false, tilted_files},
            {"striped room", striped_room}};
}

RenderSetup setup_of(const Variant& variant, int reuse, int side, std::uint32_t spp,
                     std::uint64_t seed, const std::string& sampler) {
    RenderSetup setup;
    setup.full_profile = variant.full_profile;
    setup.parameters = {{"side", std::to_string(side)},
                        {"spp", std::to_string(spp)},
                        {"seed", std::to_string(seed)},
                        {"sampler", sampler}};
    setup.adjust = [adjust = variant.adjust, reuse, sampler](Scene& scene) {
        scene.path.max_depth = 5;
        scene.path.reuse = reuse;
        scene.sampler.kind = sampler == "sobol" ? SamplerKind::sobol : SamplerKind::independent;
        adjust(scene);
    };
    return setup;
}

/// Luminances of each pixel over many seeds, without direct light, which would hide what is shared.
std::vector<MeanTest> many_seeds(const Variant& variant, int reuse, int seeds) {
    std::vector<MeanTest> pixels;
    for (int i = 0; i < seeds; ++i) {
        const auto seed = static_cast<std::uint64_t>(i) + (reuse > 1 ? 1000u : 0u);
        RenderSetup setup = setup_of(variant, reuse, 10, 16, seed, "sobol");
        const Image image = render_xml(variant.xml(), setup, variant.files).image;
        setup.adjust = [all = setup.adjust](Scene& scene) {
            all(scene);
            scene.path.max_depth = 2;
            scene.path.reuse = 1;
        };
        const Image direct = render_xml(variant.xml(), setup, variant.files).image;
        pixels.resize(image.pixels.size());
        for (std::size_t p = 0; p < image.pixels.size(); ++p)
            pixels[p].add(static_cast<double>(luminance(image.pixels[p])) -
                          static_cast<double>(luminance(direct.pixels[p])));
    }
    return pixels;
}

TEST(PathSharingImage, EveryPixelKeepsItsMean) {
    for (const Variant& variant : variants()) {
        const std::vector<MeanTest> plain = many_seeds(variant, 1, 100);
        for (const int reuse : {2, 4}) {
            const std::vector<MeanTest> shared = many_seeds(variant, reuse, 100);
            double sum = 0;
            for (std::size_t p = 0; p < plain.size(); ++p) {
                const double z = z_between(plain[p], shared[p]);
                EXPECT_LE(std::fabs(z), z_limit) << variant.name << ' ' << reuse << " pixel " << p;
                sum += z;
            }
            EXPECT_LE(std::fabs(sum), z_limit * std::sqrt(static_cast<double>(plain.size())) * 4)
                << variant.name << ' ' << reuse; // a block's pixels err alike
        }
    }
}

/// Of four seeds in the middling pixel: at the lamp's edge the film point is what errs.
double median_error(const Variant& variant, int reuse, const Image& reference) {
    std::vector<double> errors(reference.pixels.size());
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const Image image =
            render_xml(variant.xml(), setup_of(variant, reuse, 24, 16, seed, "sobol")).image;
        for (std::size_t p = 0; p < errors.size(); ++p) {
            const double d = static_cast<double>(luminance(image.pixels[p])) -
                             static_cast<double>(luminance(reference.pixels[p]));
            errors[p] += d * d;
        }
    }
    std::nth_element(errors.begin(),
                     errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
    return errors[errors.size() / 2];
}

TEST(PathSharingImage, ErrorsAreSmaller) {
    const Variant box{"box", plain_box};
    const Image reference = render_xml(box.xml(), setup_of(box, 4, 24, 4096, 99, "sobol")).image;
    const double alone = median_error(box, 1, reference);
    EXPECT_LT(median_error(box, 2, reference), 0.5 * alone);
    EXPECT_LT(median_error(box, 4, reference), 0.2 * alone);
}

TEST(PathSharingImage, HasTheSameBitsForThreadsAcceleratorsAndInstructionSets) {
    for (const Variant& variant : variants())
        for (const int reuse : {2, 4}) {
            RenderSetup setup = setup_of(variant, reuse, 21, 5, 3, "sobol");
            const std::uint64_t bits =
                bits_of(render_xml(variant.xml(), setup, variant.files).image);
            setup.threads = 3;
            EXPECT_EQ(bits_of(render_xml(variant.xml(), setup, variant.files).image), bits)
                << variant.name;
            setup.build.isa = Isa::portable;
            EXPECT_EQ(bits_of(render_xml(variant.xml(), setup, variant.files).image), bits)
                << variant.name;
            setup.accel = AccelKind::naive;
            setup.build.isa = Isa::automatic;
            EXPECT_EQ(bits_of(render_xml(variant.xml(), setup, variant.files).image), bits)
                << variant.name;
        }
}

/// Blocks that the crop cuts, batches that blocks do not fill, more samples than a block takes.
TEST(PathSharingImage, EveryPixelOfAnyCropHasItsSamples) {
    for (const auto& [crop, spp] :
         {std::pair{Crop{1, 2, 5, 3}, 3u}, std::pair{Crop{0, 0, 1, 1}, 9u},
          std::pair{Crop{3, 0, 18, 21}, 37u}}) {
        const Variant box{"box", plain_box,
                          [crop = crop](Scene& scene) { scene.film.crop = crop; }};
        const Rendered rendered = render_xml(box.xml(), setup_of(box, 4, 21, spp, 1, "sobol"));
        EXPECT_EQ(rendered.stats.samples, static_cast<std::uint64_t>(crop.width) *
                                              static_cast<std::uint64_t>(crop.height) * spp);
        for (const Rgb& pixel : rendered.image.pixels)
            EXPECT_GT(luminance(pixel), 0);
    }
}

/// Nothing comes from beyond the second vertex of paths of one segment; where all is alone in its
/// block, nothing is shared.
TEST(PathSharingImage, WithoutAnythingToShareThereIsNothingNew) {
    const Variant one{"one segment", plain_box, [](Scene& scene) { scene.path.max_depth = 1; }};
    EXPECT_EQ(bits_of(render_xml(one.xml(), setup_of(one, 4, 21, 5, 3, "sobol")).image),
              bits_of(render_xml(one.xml(), setup_of(one, 1, 21, 5, 3, "sobol")).image));
    const Variant alone{"one pixel", plain_box, [](Scene& scene) {
                            scene.film.crop = {9, 9, 1, 1};
                        }};
    const Rgb shared =
        render_xml(alone.xml(), setup_of(alone, 4, 21, 64, 3, "sobol")).image.pixels[0];
    const Rgb plain =
        render_xml(alone.xml(), setup_of(alone, 1, 21, 64, 3, "sobol")).image.pixels[0];
    EXPECT_NEAR(shared.r, plain.r, 1e-5f * plain.r);
    EXPECT_NEAR(shared.g, plain.g, 1e-5f * plain.g);
    EXPECT_NEAR(shared.b, plain.b, 1e-5f * plain.b);
}

} // namespace
} // namespace plumb::test
