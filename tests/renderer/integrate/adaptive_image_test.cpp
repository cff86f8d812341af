/// \file  Renders that end by error or by time: unbiased, reproducible, and as exact as they say.

#include "renderer/integrate/pixel_error.h"
#include "renderer/scene/scene_tables.h"
#include "tests/support/box_scenes.h"
#include "tests/support/render_scene.h"
#include "tests/support/statistics.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace plumb::test {
namespace {

constexpr std::uint32_t much = 1u << 16; // a bound that no render here meets

RenderSetup setup_of(const std::string& sampler, std::uint32_t spp, double target_error,
                     int side = 20) {
    RenderSetup setup;
    setup.parameters = {{"side", std::to_string(side)},
                        {"spp", std::to_string(spp)},
                        {"sampler", sampler},
                        {"seed", "5"}};
    setup.stop.target_error = target_error;
    setup.adjust = [](Scene& scene) {
        scene.path.max_depth = 5;
        scene.path.rr_depth = 2;
    };
    return setup;
}

TEST(AdaptiveImage, EveryNumberOfThreadsGivesTheSameBits) {
    for (const auto xml : {plain_box, rich_box})
        for (const std::string sampler : {"sobol", "independent"}) {
            RenderSetup setup = setup_of(sampler, much, 0.25);
            const Rendered one = render_xml(xml(), setup);
            ASSERT_TRUE(one.stats.reached);
            EXPECT_LT(one.stats.reached->spp_min, one.stats.reached->spp_max);
            for (const int threads : {2, 3, 8}) {
                setup.threads = threads;
                const Rendered many = render_xml(xml(), setup);
                EXPECT_EQ(bits_of(many.image), bits_of(one.image)) << sampler << ' ' << threads;
                EXPECT_EQ(many.stats.samples, one.stats.samples);
            }
            setup.ray_by_ray = true;
            EXPECT_EQ(bits_of(render_xml(xml(), setup).image), bits_of(one.image)) << sampler;
        }
}

/// Pixels that are there, and the mean of their luminances.
using Region = std::vector<std::size_t>;

double mean_over(const Region& region, const Image& image) {
    double sum = 0;
    for (const std::size_t p : region)
        sum += static_cast<double>(luminance(image.pixels[p]));
    return sum / static_cast<double>(region.size());
}

/// The whole image, its darkest and brightest fifth, and its fifth with the largest steps.
std::map<std::string, Region> regions_of(const Image& image) {
    const auto width = static_cast<std::size_t>(image.width);
    Region all;
    std::vector<float> level, step;
    for (std::size_t p = 0; p < image.pixels.size(); ++p) {
        const auto at = [&](std::size_t q) { return luminance(image.pixels[q]); };
        all.push_back(p);
        level.push_back(at(p));
        step.push_back(std::fabs(at(p) - at(p % width > 0 ? p - 1 : p)) +
                       std::fabs(at(p) - at(p >= width ? p - width : p)));
    }
    const auto fifth = [&all](const std::vector<float>& by, bool largest) {
        Region sorted = all;
        std::sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) {
            return largest ? by[a] > by[b] : by[a] < by[b];
        });
        return Region(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(all.size() / 5));
    };
    return {{"image", all},
            {"dark", fifth(level, false)},
            {"bright", fifth(level, true)},
            {"edges", fifth(step, true)}};
}

/// The box as a scene to render many times, with samples that are skewed: with Estimator::bsdf the
/// lamp is only found by chance.
class ManySeeds {
  public:
    ManySeeds(const std::string& sampler, Estimator estimator) {
        RenderSetup setup = setup_of(sampler, much, 0, 12);
        setup.adjust = [this, estimator](Scene& loaded) {
            loaded.path.estimator = estimator;
            loaded.path.max_depth = 3;
            scene_ = loaded;
            loaded.film.crop = {0, 0, 1, 1};
            loaded.sampler.spp = 1;
        };
        static_cast<void>(render_xml(plain_box(), setup));
        tables_.emplace(scene_);
        sah_ = make_intersector(AccelKind::sah, tables_->geometry());
    }

    [[nodiscard]] Crop whole() const { return scene_.film.crop; }

    [[nodiscard]] Rendered render(const Crop& crop, std::uint64_t seed, std::uint32_t spp,
                                  double target_error) const {
        RenderJob job = make_job(scene_, tables_->view());
        job.crop = crop;
        job.sampler.seed = seed;
        job.sampler.spp = spp;
        RenderOptions how;
        how.threads = 1;
        how.stop.target_error = target_error;
        Rendered result;
        result.image = plumb::render(job, features_of(scene_), *sah_, how, result.stats).resolve();
        return result;
    }

    /// Means over seeds 1 .. `seeds` of the regions of a crop: adaptive sampling against uniform.
    /// Returns the number of samples a pixel over the renders, fewest and most.
    std::pair<std::uint32_t, std::uint32_t> compare(const std::string& name, const Crop& crop,
                                                    std::map<std::string, Region> regions,
                                                    double target_error,
                                                    std::uint64_t seeds) const {
        std::map<std::string, MeanTest> adaptive, uniform;
        std::uint32_t fewest = much, most = 0;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            const Rendered a = render(crop, seed, much, target_error);
            const Image u = render(crop, seed + seeds, 192, 0).image;
            fewest = std::min(fewest, a.stats.reached->spp_min);
            most = std::max(most, a.stats.reached->spp_max);
            for (const auto& [region, pixels] : regions) {
                adaptive[region].add(mean_over(pixels, a.image));
                uniform[region].add(mean_over(pixels, u));
            }
        }
        for (const auto& [region, pixels] : regions) {
            const double z = z_between(adaptive[region], uniform[region]);
            EXPECT_LE(std::fabs(z), z_limit) << name << ' ' << region;
            fmt::print("{}, {}: adaptive / uniform {:.5f}, z {:.2f}, {} to {} samples\n", name,
                       region, adaptive[region].mean() / uniform[region].mean(), z, fewest, most);
        }
        return {fewest, most};
    }

  private:
    Scene scene_;
    std::optional<SceneTables> tables_;
    std::unique_ptr<Intersector> sah_;
};

constexpr std::uint64_t reference_seed = 1'000'000'000;

/// Images: neighbours, the floor and the share of pixels take part in the decisions.
TEST(AdaptiveImage, IsUnbiasedInEveryRegion) {
    const struct {
        const char* sampler;
        Estimator estimator;
        double target_error;
    } cases[] = {{"independent", Estimator::bsdf, 0.8}, {"sobol", Estimator::mis, 0.3}};
    for (const auto& c : cases) {
        const ManySeeds box(c.sampler, c.estimator);
        const Image reference = box.render(box.whole(), reference_seed, 1024, 0).image;
        const auto [fewest, most] =
            box.compare(c.sampler, box.whole(), regions_of(reference), c.target_error, 120);
        EXPECT_EQ(fewest, 64u);
        EXPECT_GE(most, 256u) << "the numbers of samples should differ";
    }
}

/// Single pixels, each its own image: nothing but its own samples takes part, and a stopping rule
/// that looks at the samples it keeps is off by several per cent.
TEST(AdaptiveImage, IsUnbiasedInSinglePixelsOverThousandsOfSeeds) {
    for (const std::string sampler : {"independent", "sobol"}) {
        const ManySeeds box(sampler, Estimator::bsdf);
        const Crop whole = box.whole();
        const Image reference = box.render(whole, reference_seed, 1024, 0).image;
        for (const auto& [name, region] : regions_of(reference)) {
            const std::size_t pixel = region[region.size() / 2];
            const Crop crop{static_cast<int>(pixel) % whole.width,
                            static_cast<int>(pixel) / whole.width, 1, 1};
            box.compare(sampler + " " + name, crop, {{"pixel", {0}}}, 0.5, 3000);
        }
    }
}

/// The error that it stops at is what a far more exact render finds.
TEST(AdaptiveImage, StopsWithinTheTargetOnAllButFewPixels) {
    constexpr double target = 0.1;
    RenderSetup exact = setup_of("sobol", 16384, 0);
    exact.parameters.back().second = "6";
    const Image reference = render_xml(plain_box(), exact).image;
    const double n = static_cast<double>(reference.pixels.size());
    double mean = 0;
    for (const Rgb& p : reference.pixels)
        mean += static_cast<double>(luminance(p)) / n;
    for (const std::string sampler : {"independent", "sobol"}) {
        const Rendered run = render_xml(plain_box(), setup_of(sampler, much, target));
        EXPECT_EQ(run.stats.stopped_by, StoppedBy::target_error);
        EXPECT_NEAR(run.stats.reached->error, target, 0.2 * target);
        double within = 0, squares = 0;
        for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
            const double a = static_cast<double>(luminance(run.image.pixels[i]));
            const double b = static_cast<double>(luminance(reference.pixels[i]));
            const double error = std::fabs(a - b) / std::max(b, floor_of_mean * mean);
            within += error <= target ? 1 / n : 0;
            squares += error * error / n;
        }
        EXPECT_GE(within, 0.93) << sampler << ": 95 % confidence";
        // In standard deviations of a pixel that just meets the target.
        const double rms = std::sqrt(squares) / (target / confidence_95);
        EXPECT_LT(rms, 1) << sampler;
        if (sampler == "independent") { // nor is it far too exact
            EXPECT_GT(rms, 0.4);
        }
        fmt::print("{}: {:.1f} % of pixels within, rms {:.2f} of the target's\n", sampler,
                   100 * within, rms);
    }
}

TEST(AdaptiveImage, ConvergedPixelsGetNoMoreSamples) {
    const Rendered run = render_xml(plain_box(), setup_of("independent", much, 0.1));
    ASSERT_TRUE(run.stats.reached);
    const Reached& reached = *run.stats.reached;
    EXPECT_LE(reached.spp_min, 128u); // close to the 64 of the first round
    EXPECT_GE(reached.spp_max, 8 * reached.spp_min);
    // Uniform sampling would give every pixel what the hardest needs.
    const double pixels = static_cast<double>(run.image.pixels.size());
    EXPECT_LT(static_cast<double>(run.stats.samples), 0.6 * pixels * reached.spp_max);
    EXPECT_GE(static_cast<double>(run.stats.samples), pixels * reached.spp_mean);
}

/// A wall, its left half with four hundred times the reflectance of its right, before a lamp that
/// one direction in ten finds: all pixels are equally noisy for their brightness, 1.96 sqrt(9 / 64)
/// = 0.7 after the first round. Against a tenth of the image's mean, the dark ones are good enough
/// by then.
constexpr const char* half_dark_wall = R"(<scene version="3.0.0">
<default name="side" value="20"/><default name="spp" value="16"/><default name="seed" value="0"/>
<default name="sampler" value="independent"/><integrator type="path"/>
<sensor type="perspective"><float name="fov" value="39"/>
<transform name="to_world"><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="$side"/><integer name="height" value="$side"/></film>
<sampler type="$sampler"><integer name="sample_count" value="$spp"/>
<integer name="seed" value="$seed"/></sampler></sensor>
<shape type="rectangle"><transform name="to_world"><scale x="2" y="2"/><translate x="-2"/></transform>
<bsdf type="diffuse"><rgb name="reflectance" value="0.8"/></bsdf></shape>
<shape type="rectangle"><transform name="to_world"><scale x="2" y="2"/><translate x="2"/></transform>
<bsdf type="diffuse"><rgb name="reflectance" value="0.002"/></bsdf></shape>
<shape type="rectangle"><transform name="to_world"><scale x="2" y="2"/>
<rotate y="1" angle="180"/><translate z="6"/></transform>
<emitter type="area"><rgb name="radiance" value="5"/></emitter></shape></scene>)";

TEST(AdaptiveImage, PixelsFarDarkerThanTheImageNeedNotBeAsExact) {
    RenderSetup setup = setup_of("independent", much, 0.2);
    setup.adjust = [](Scene& scene) {
        scene.path.max_depth = 2;
        scene.path.estimator = Estimator::bsdf;
    };
    const Rendered run = render_xml(half_dark_wall, setup);
    EXPECT_EQ(run.stats.stopped_by, StoppedBy::target_error);
    EXPECT_EQ(run.stats.reached->spp_min, 64u) << "the dark half";
    EXPECT_GE(run.stats.reached->spp_max, 512u) << "the bright half";
}

TEST(AdaptiveImage, TheSamplesPerPixelStayTheUpperBound) {
    for (const std::uint32_t spp : {4u, 7u, 100u, 256u}) {
        const Rendered run = render_xml(plain_box(), setup_of("sobol", spp, 1e-4));
        EXPECT_EQ(run.stats.stopped_by, StoppedBy::spp);
        EXPECT_EQ(run.stats.reached->spp_max, spp / 2 * 2);
        EXPECT_GT(run.stats.reached->error, 1e-4);
        EXPECT_LE(run.stats.samples, std::uint64_t{spp} * run.image.pixels.size());
    }
}

TEST(TimeLimitImage, TheImageIsThatOfTheSamplesReached) {
    for (const auto xml : {plain_box, rich_box}) {
        RenderSetup setup = setup_of("sobol", 1u << 24, 0);
        setup.threads = 2;
        setup.stop.time_limit_s = 0.3;
        const Rendered timed = render_xml(xml(), setup);
        EXPECT_EQ(timed.stats.stopped_by, StoppedBy::time_limit);
        ASSERT_TRUE(timed.stats.reached);
        const std::uint32_t n = timed.stats.reached->spp_min;
        EXPECT_EQ(timed.stats.reached->spp_max, n);
        EXPECT_GE(n, 1u);
        RenderSetup plain = setup_of("sobol", n, 0);
        const Rendered same = render_xml(xml(), plain);
        EXPECT_EQ(bits_of(timed.image), bits_of(same.image)) << n << " samples";
        EXPECT_EQ(timed.stats.samples, same.stats.samples);
        EXPECT_TRUE(timed.image.variance.empty());
        EXPECT_FALSE(same.stats.reached);
        EXPECT_EQ(same.stats.stopped_by, StoppedBy::spp);
    }
}

TEST(TimeLimitImage, TooLittleTimeIsOneSampleAndPlentyIsAll) {
    RenderSetup setup = setup_of("sobol", 1000, 0);
    setup.stop.time_limit_s = 1e-6;
    const Rendered one = render_xml(plain_box(), setup);
    EXPECT_EQ(one.stats.reached->spp_max, 1u);
    EXPECT_TRUE(std::isinf(one.stats.reached->error)); // one sample knows no error
    setup.stop.time_limit_s = 3600;
    setup.parameters[1].second = "24";
    const Rendered all = render_xml(plain_box(), setup);
    EXPECT_EQ(all.stats.stopped_by, StoppedBy::spp);
    EXPECT_EQ(all.stats.reached->spp_min, 24u);
}

TEST(TimeLimitImage, EndsAnAdaptiveRenderToo) {
    RenderSetup setup = setup_of("sobol", 1u << 24, 1e-5);
    setup.stop.time_limit_s = 0.3;
    const Rendered run = render_xml(plain_box(), setup);
    EXPECT_EQ(run.stats.stopped_by, StoppedBy::time_limit);
    EXPECT_LT(run.stats.render_s, 3);
    EXPECT_GT(run.stats.reached->error, 1e-5);
}

} // namespace
} // namespace plumb::test
