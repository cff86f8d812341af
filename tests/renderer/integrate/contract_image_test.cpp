/// \file  The determinism contract over the scenes of scenes/: one test an axis, one row a way to
/// render along it.
///
/// All ways are held to the plain one: the naive tree, one thread, ray by ray. What else the
/// contract says is held elsewhere: determinism_image_test (variance, Moeller-Trumbore, other
/// seeds), adaptive_image_test (--target-error, --time-limit), streams_image_test (every setting of
/// the estimators), determinism_command_test (the program's flags).

#include "renderer/integrate/tiles.h"
#include "tests/accel/intersector_suite.h"
#include "tests/support/interruption.h"
#include "tests/support/random.h"
#include "tests/support/render_scene.h"

#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

namespace plumb::test {
namespace {

constexpr const char* scene_names[] = {"cornell-box", "furnace",      "many-lights",
                                       "mesh-light",  "sphere-light", "white-room"};
constexpr int side = 36; // no multiple of a tile or a block
constexpr std::uint32_t spp = 5;

std::filesystem::path file_of(const std::string& scene) {
    return std::filesystem::path(PLUMB_SOURCE_DIR) / "scenes" / (scene + ".xml");
}

/// One way to render.
struct Way {
    std::string name;
    std::function<void(RenderSetup&)> set;
};

class Contract : public ::testing::TestWithParam<std::tuple<const char*, SamplerKind>> {
  protected:
    static std::string scene_name() { return std::get<0>(GetParam()); }

    static RenderSetup setup() {
        RenderSetup s;
        s.parameters = {{"res", std::to_string(side)}, {"spp", std::to_string(spp)}};
        s.adjust = [kind = std::get<1>(GetParam())](Scene& scene) {
            scene.sampler.kind = kind;
            scene.sampler.seed = 11;
            scene.path.rr_depth = 2;
        };
        return s;
    }
    static RenderSetup plain_setup() {
        RenderSetup s = setup();
        s.accel = AccelKind::naive;
        s.ray_by_ray = true;
        return s;
    }

    static const Rendered& plain() {
        static std::map<std::string, Rendered> done;
        const std::string name =
            scene_name() + (std::get<1>(GetParam()) == SamplerKind::sobol ? "s" : "i");
        const auto found = done.find(name);
        return found != done.end() ? found->second
                                   : done[name] = render_file(file_of(scene_name()), plain_setup());
    }

    static void expect_plain(const Rendered& got, const std::string& way) {
        EXPECT_EQ(bits_of(got.image), bits_of(plain().image)) << way;
        EXPECT_EQ(got.stats.rays.camera, plain().stats.rays.camera) << way;
        EXPECT_EQ(got.stats.rays.bounce, plain().stats.rays.bounce) << way;
        EXPECT_EQ(got.stats.rays.shadow, plain().stats.rays.shadow) << way;
    }

    static void expect_same_along(const std::vector<Way>& axis) {
        for (const Way& way : axis) {
            RenderSetup s = setup();
            way.set(s);
            expect_plain(render_file(file_of(scene_name()), s), way.name);
        }
    }

    /// For the films, which are compared before they are rounded to an image.
    static RenderSetup film_setup() {
        RenderSetup s = setup();
        s.variance = true;
        return s;
    }
    static Film film_at_once(const LoadedScene& loaded, const RenderJob& job) {
        RenderStats stats;
        return render(job, loaded.features(), loaded.intersector(), loaded.options(), stats);
    }
};

TEST_P(Contract, SomethingIsToBeSeen) {
    std::vector<Rgb> pixels = plain().image.pixels;
    ASSERT_EQ(pixels.size(), std::size_t{side} * side);
    std::sort(pixels.begin(), pixels.end(), [](Rgb a, Rgb b) { return a.g < b.g; });
    EXPECT_GT(pixels[pixels.size() / 2].g, 0);
    EXPECT_GT(plain().stats.rays.bounce, plain().stats.rays.camera / 4);
}

TEST_P(Contract, AnyNumberOfThreads) {
    std::vector<Way> axis;
    for (const int n : {1, 2, 3, 5, 8})
        axis.push_back({fmt::format("{} threads", n), [n](RenderSetup& s) { s.threads = n; }});
    expect_same_along(axis);
}

TEST_P(Contract, EveryAccelerator) {
    std::vector<Way> axis;
    for (const AccelKind kind : {AccelKind::naive, AccelKind::sah})
        for (const bool ray_by_ray : {false, true})
            axis.push_back(
                {fmt::format("{}{}", plumb::name_of(kind), ray_by_ray ? " ray by ray" : ""),
                 [=](RenderSetup& s) {
                     s.accel = kind;
                     s.ray_by_ray = ray_by_ray;
                 }});
    expect_same_along(axis);
}

TEST_P(Contract, EveryInstructionSet) {
    std::vector<Way> axis;
    for (const Isa isa : isas_here()) // what this processor lacks cannot be tried
        for (const bool ray_by_ray : {false, true})
            axis.push_back(
                {fmt::format("{}{}", plumb::name_of(isa), ray_by_ray ? " ray by ray" : ""),
                 [=](RenderSetup& s) {
                     s.build.isa = isa;
                     s.ray_by_ray = ray_by_ray;
                 }});
    expect_same_along(axis);
}

TEST_P(Contract, EveryBuildQuality) {
    std::vector<Way> axis;
    for (const auto quality : {BuildQuality::fast, BuildQuality::medium, BuildQuality::high})
        for (const int threads : {1, 3})
            axis.push_back({fmt::format("{}, {} threads", plumb::name_of(quality), threads),
                            [=](RenderSetup& s) {
                                s.build.quality = quality;
                                s.build.threads = threads;
                            }});
    expect_same_along(axis);
}

TEST_P(Contract, EveryKernel) {
    expect_same_along({{"general", [](RenderSetup& s) { s.full_profile = true; }},
                       {"general, ray by ray",
                        [](RenderSetup& s) {
                            s.full_profile = true;
                            s.ray_by_ray = true;
                        }},
                       {"with variance", [](RenderSetup& s) { s.variance = true; }}});
}

/// The text of a version 3 scene as dialect 0.6 writes it: camelCase names of properties.
std::string in_dialect_06(const std::string& version3) {
    std::istringstream lines(version3);
    std::string result, line;
    while (std::getline(lines, line)) {
        if (const auto version = line.find("version=\"3.0.0\""); version != std::string::npos)
            line.replace(version, 15, "version=\"0.6.0\"");
        for (std::size_t at = line.find("<lookat"); at != std::string::npos;
             at = line.find("<lookat", at))
            line.replace(at, 7, "<lookAt");
        if (line.find("<default") == std::string::npos)
            for (std::size_t at = line.find("name=\""); at != std::string::npos;
                 at = line.find("name=\"", at + 6))
                for (std::size_t i = at + 6; line[i] != '"'; ++i)
                    if (line[i] == '_') {
                        line.erase(i, 1);
                        line[i] = static_cast<char>(line[i] - 'a' + 'A');
                    }
        result += line + '\n';
    }
    return result;
}

TEST_P(Contract, BothDialects) {
    std::ostringstream text;
    text << std::ifstream(file_of(scene_name())).rdbuf();
    std::string other = in_dialect_06(text.str());
    for (const char* word : {"version=\"0.6.0\"", "toWorld", "lookAt", "sampleCount", "maxDepth"})
        ASSERT_NE(other.find(word), std::string::npos) << word;
    for (const char* word : {"to_world", "lookat", "sample_count", "version=\"3"})
        ASSERT_EQ(other.find(word), std::string::npos) << word;
    // Meshes are found where the scene came from.
    other.replace(other.find("<scene version=\"0.6.0\">"), 23,
                  fmt::format(R"(<scene version="0.6.0"><path value="{}"/>)",
                              file_of(scene_name()).parent_path().string()));
    expect_plain(render_xml(other, setup()), "dialect 0.6");
}

TEST_P(Contract, EveryCrop) {
    const Image& whole = plain().image;
    for (const Crop crop : {Crop{0, 0, side, side}, Crop{5, 3, 7, 9}, Crop{15, 17, 20, 2},
                            Crop{35, 0, 1, side}, Crop{35, 35, 1, 1}}) {
        RenderSetup s = setup();
        s.adjust = [crop, inner = s.adjust](Scene& scene) {
            inner(scene);
            scene.film.crop = crop;
        };
        const Image part = render_file(file_of(scene_name()), s).image;
        ASSERT_EQ(part.width, crop.width);
        ASSERT_EQ(part.height, crop.height);
        for (int y = 0; y < crop.height; ++y)
            ASSERT_EQ(
                std::memcmp(&part.pixels[static_cast<std::size_t>(y * crop.width)],
                            &whole.pixels[static_cast<std::size_t>((y + crop.y) * side + crop.x)],
                            static_cast<std::size_t>(crop.width) * sizeof(Rgb)),
                0)
                << "row " << y << " of the crop at " << crop.x << ' ' << crop.y;
    }
}

/// Rectangles of at most 7 x 5 pixels, which no tile or block fits.
std::vector<Crop> pieces_of(const Crop& whole) {
    std::vector<Crop> pieces;
    for (int y = 0; y < whole.height; y += 5)
        for (int x = 0; x < whole.width; x += 7)
            pieces.push_back({whole.x + x, whole.y + y, std::min(7, whole.width - x),
                              std::min(5, whole.height - y)});
    return pieces;
}

TEST_P(Contract, AnyOrderOfTiles) {
    const LoadedScene loaded(file_of(scene_name()), film_setup());
    const RenderJob job = loaded.job();
    const Film whole = film_at_once(loaded, job);
    EXPECT_EQ(bits_of(whole.resolve()), bits_of(plain().image));
    const TileRenderer tiles(loaded.features(), loaded.intersector(), loaded.options());
    for (const std::uint64_t order : {1u, 2u, 3u}) {
        Random random(order);
        std::vector<Crop> pieces = pieces_of(job.crop);
        for (std::size_t i = pieces.size(); i > 1; --i)
            std::swap(pieces[i - 1], pieces[random.index(static_cast<std::uint32_t>(i))]);
        Film film(job.width, job.height, job.crop, true);
        RayCounts rays;
        for (const Crop& piece : pieces) {
            RenderJob part = job;
            part.crop = piece;
            tiles.render(part, {0, spp}, nullptr, film, rays, {});
        }
        EXPECT_EQ(bits_of(film), bits_of(whole)) << "order " << order;
    }
}

TEST_P(Contract, AnyCutIntoRangesOfSamples) {
    const LoadedScene loaded(file_of(scene_name()), film_setup());
    const RenderJob job = loaded.job();
    const std::uint64_t whole = bits_of(film_at_once(loaded, job));
    for (const int threads : {1, 3}) {
        RenderOptions how = loaded.options();
        how.threads = threads;
        const TileRenderer tiles(loaded.features(), loaded.intersector(), how);
        for (const std::vector<std::uint32_t>& ends :
             {std::vector<std::uint32_t>{5}, {1, 5}, {4, 5}, {1, 2, 3, 4, 5}, {2, 2, 5}}) {
            Film film(job.width, job.height, job.crop, true);
            RayCounts rays;
            std::uint32_t first = 0;
            for (const std::uint32_t end : ends) {
                tiles.render(job, {first, end}, nullptr, film, rays, {});
                first = end;
            }
            EXPECT_EQ(bits_of(film), whole) << threads << " threads, " << ends.size() << " ranges";
        }
    }
}

/// Pixels of a film with this many samples.
PixelMask with_count(const Film& film, std::uint32_t count) {
    PixelMask mask(film.crop());
    for (std::size_t p = 0; p < film.pixels().size(); ++p)
        if (film.pixels()[p].count != count)
            mask.remove(p);
    return mask;
}

TEST_P(Contract, StoppedAnywhereAndGoneOn) {
    const LoadedScene loaded(file_of(scene_name()), film_setup());
    RenderJob job = loaded.job();
    job.sampler.spp = 40; // more than a block's samples, so that pixels are left half done
    const std::uint64_t whole = bits_of(film_at_once(loaded, job));
    bool half_done = false;
    for (const int streams : {1, 20, 166}) {
        std::atomic<bool> cancel{false};
        const Interruption interruption(loaded.intersector(), streams, cancel);
        RenderOptions how = loaded.options();
        how.cancel = &cancel;
        RenderStats stats;
        Film film = render(job, loaded.features(), interruption, how, stats);
        ASSERT_NE(bits_of(film), whole) << "stopped too late to test anything";
        const TileRenderer tiles(loaded.features(), loaded.intersector(), loaded.options());
        const Film stopped = film;
        RayCounts rays;
        for (std::uint32_t done = 0; done < job.sampler.spp; ++done) {
            const PixelMask rest = with_count(stopped, done);
            half_done = half_done || (done > 0 && rest.count() > 0);
            if (rest.count() > 0)
                tiles.render(job, {done, job.sampler.spp}, &rest, film, rays, {});
        }
        EXPECT_EQ(bits_of(film), whole) << "after " << streams << " streams";
    }
    EXPECT_TRUE(half_done) << "no pixel was left in the middle of its samples";
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Contract,
    ::testing::Combine(::testing::ValuesIn(scene_names),
                       ::testing::Values(SamplerKind::sobol, SamplerKind::independent)),
    [](const auto& tested) {
        std::string name = std::get<0>(tested.param);
        std::replace(name.begin(), name.end(), '-', '_');
        return name + (std::get<1>(tested.param) == SamplerKind::sobol ? "_sobol" : "_independent");
    });

} // namespace
} // namespace plumb::test
