/// \file  Replay files: every bit comes back, bad ones are refused by line, and they run alone.

#include "accel/validate/run_replay.h"
#include "tests/accel/validate_support.h"

#include <algorithm>
#include <sstream>

namespace plumb::test {
namespace {

/// Any bits but those of a NaN.
float any_float(Random& random) {
    const auto x = std::bit_cast<float>(random.bits());
    return std::isnan(x) ? -0.0f : x;
}

Vec3 any_point(Random& random) {
    const float x = any_float(random), y = any_float(random);
    return {x, y, any_float(random)};
}

Hit any_hit(Random& random) {
    if (random.index(4) == 0)
        return {};
    Hit hit;
    hit.t = any_float(random);
    hit.u = any_float(random);
    hit.v = any_float(random);
    hit.geometry = random.index(100);
    hit.primitive = random.bits();
    return hit;
}

Replay any_replay(Random& random) {
    Replay replay;
    replay.scene = "a folder/scene file.xml";
    replay.triangle_test = TriangleTest::moeller_trumbore;
    replay.first = AccelKind::embree;
    replay.second = AccelKind::naive;
    for (std::uint32_t i = 0; i < 200; ++i) {
        ReplayPrimitive p;
        p.is_sphere = i >= 150;
        p.geometry = p.is_sphere ? 90 : i / 10;
        p.primitive = 7 * i;
        if (p.is_sphere)
            p.sphere = {any_point(random), any_float(random)};
        else
            p.triangle = {any_point(random), any_point(random), any_point(random)};
        replay.primitives.push_back(p);
    }
    for (int i = 0; i < 300; ++i) {
        Disagreement d;
        d.ray = {any_point(random), any_float(random), any_point(random), infinity};
        d.kind = static_cast<RayKind>(random.index(3));
        d.verdict.agreement = static_cast<Agreement>(random.index(agreement_count));
        d.verdict.culprit = static_cast<Culprit>(random.index(4));
        d.answers.any_hit = d.kind == RayKind::shadow;
        d.answers.first = any_hit(random);
        d.answers.second = any_hit(random);
        d.answers.first_found = d.answers.any_hit && random.index(2) == 0;
        d.answers.second_found = d.answers.any_hit && random.index(2) == 0;
        replay.rays.push_back(d);
    }
    return replay;
}

bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}
bool same_bits(Vec3 a, Vec3 b) {
    return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

bool same(const ReplayPrimitive& a, const ReplayPrimitive& b) {
    return a.geometry == b.geometry && a.primitive == b.primitive && a.is_sphere == b.is_sphere &&
           same_bits(a.triangle.a, b.triangle.a) && same_bits(a.triangle.b, b.triangle.b) &&
           same_bits(a.triangle.c, b.triangle.c) && same_bits(a.sphere.center, b.sphere.center) &&
           same_bits(a.sphere.radius, b.sphere.radius);
}

bool same(const Disagreement& a, const Disagreement& b) {
    return a.kind == b.kind && a.verdict == b.verdict && same_bits(a.ray.origin, b.ray.origin) &&
           same_bits(a.ray.tmin, b.ray.tmin) && same_bits(a.ray.direction, b.ray.direction) &&
           same_bits(a.ray.tmax, b.ray.tmax) && a.answers.any_hit == b.answers.any_hit &&
           test::same_bits(a.answers.first, b.answers.first) &&
           test::same_bits(a.answers.second, b.answers.second) &&
           a.answers.first_found == b.answers.first_found &&
           a.answers.second_found == b.answers.second_found;
}

TEST(ReplayFile, EveryBitComesBack) {
    Random random(221);
    for (int round = 0; round < 20; ++round) {
        const Replay written = any_replay(random);
        const std::string text = to_text(written);
        const Replay read = parse_replay(text);
        EXPECT_EQ(read.scene, written.scene);
        EXPECT_EQ(read.triangle_test, written.triangle_test);
        EXPECT_EQ(read.first, written.first);
        EXPECT_EQ(read.second, written.second);
        EXPECT_EQ(read.whole_geometry, written.whole_geometry);
        EXPECT_TRUE(std::equal(read.primitives.begin(), read.primitives.end(),
                               written.primitives.begin(), written.primitives.end(),
                               [](const auto& a, const auto& b) { return same(a, b); }));
        EXPECT_TRUE(std::equal(read.rays.begin(), read.rays.end(), written.rays.begin(),
                               written.rays.end(),
                               [](const auto& a, const auto& b) { return same(a, b); }));
        EXPECT_EQ(to_text(read), text);
    }
}

TEST(ReplayFile, CommentsEmptyLinesAndCarriageReturnsAreFine) {
    const Replay replay = parse_replay("# made by hand\r\n\r\nplumbline-replay 1\r\n"
                                       "test watertight\r\npair naive sah\r\n# two\r\n"
                                       "geometry whole\r\n sphere 0  0 0 0 0 1.8p+1 \r\nend");
    ASSERT_EQ(replay.primitives.size(), 1u);
    EXPECT_EQ(replay.primitives[0].sphere.radius, 3);
    EXPECT_TRUE(replay.whole_geometry);
}

struct BadFile {
    const char* text;
    const char* message;
};

TEST(ReplayFile, BadFilesAreRefusedByLine) {
    const std::string head =
        "plumbline-replay 1\ntest watertight\npair naive sah\ngeometry whole\n";
    const std::string ray = "ray bounce miss second 0 0 0 0 0 0 1 inf\n";
    const BadFile files[] = {
        {"", "line 1: another record (got 'end of file', expected plumbline-replay)"},
        {"P6\n", "line 1: another record (got 'P6', expected plumbline-replay)"},
        {"plumbline-replay 2\n", "line 1: unknown version (got '2', expected 1)"},
        {"plumbline-replay 1 beta\n", "line 1: too many fields (got 'beta'"},
        {"plumbline-replay 1\n\ntest sloppy\n", "line 3: unknown name (got 'sloppy'"},
        {"plumbline-replay 1\ntest watertight\npair naive octree\n",
         "line 3: unknown name (got 'octree', expected naive, sah or embree)"},
        {"H", "line 5: another record (got 'end of file', expected end)"},
        {"Htriangle 0 0 0 0\n",
         "line 5: the line ends early (got '', expected a hexadecimal float)"},
        {"Htriangle 0 -1 0 0 0 0 0 0 0 0 0\n", "line 5: bad number (got '-1'"},
        {"Htriangle 4294967296 0 0 0 0 0 0 0 0 0 0\n", "line 5: bad number (got '4294967296'"},
        {"Hsphere 0 0 0 0 0 1x\n", "line 5: bad number (got '1x', expected a hexadecimal float)"},
        {"Hsphere 0 0 0 0 0 1 1\n", "line 5: too many fields (got '1'"},
        {"Hsphere 0 1 0 0 0 1\nsphere 0 1 0 0 0 1\n", "line 6: ids out of order (got '0 1'"},
        {"Hsphere 0 1 0 0 0 1\nsphere 1 0 0 0 0 1\n", "line 6: a second geometry after"},
        {"Htriangle 0 0 0 0 0 0 0 0 0 0 0\nsphere 0 1 0 0 0 1\n", "line 6: triangles and spheres"},
        {"Hray sideways miss second 0 0 0 0 0 0 1 inf\n", "line 5: unknown name (got 'sideways'"},
        {"HRfirst miss\nend\n", "line 7: another record (got 'end', expected second)"},
        {"HRfirst perhaps\n", "line 6: unknown answer (got 'perhaps', expected hit or miss)"},
        {"HRfirst hit 0 0 1 0\n", "line 6: the line ends early"},
        {"Hray shadow miss second 0 0 0 0 0 0 1 inf\nfirst miss\n",
         "line 6: unknown answer (got 'miss', expected blocked or free)"},
        {"Hend\nmore\n", "line 6: text after the end (got 'more'"},
    };
    for (const BadFile& file : files) {
        std::string text = file.text;
        if (text.starts_with('H'))
            text = head + (text.starts_with("HR") ? ray + text.substr(2) : text.substr(1));
        try {
            (void)parse_replay(text);
            ADD_FAILURE() << "accepted: " << text;
        } catch (const ReplayError& error) {
            EXPECT_EQ(std::string(error.what()).substr(0, std::string(file.message).size()),
                      file.message)
                << text;
        }
    }
}

TEST(ReplayFile, CutAnywhereItIsRefused) {
    Random random(222);
    Replay replay = any_replay(random);
    replay.primitives.resize(2);
    replay.rays.resize(2);
    const std::string text = to_text(replay);
    for (std::size_t size = 0; size + 1 < text.size(); ++size)
        EXPECT_THROW((void)parse_replay(text.substr(0, size)), ReplayError) << size;
}

/// Rays on which the two differ in some scene, as --replay-all keeps them.
Replay disagreements(const TestGeometry& scene, const Intersector& first,
                     const Intersector& second) {
    ValidationOptions keep;
    keep.keep_explained = 100;
    const ValidatingIntersector both(scene.view(), first, second, keep);
    Random random(223);
    for (int i = 0; i < 3000; ++i) {
        (void)static_cast<const Intersector&>(both).closest(random_ray(random));
        (void)static_cast<const Intersector&>(both).occluded(random_ray(random));
    }
    const ValidationReport report = both.report();
    std::vector<Disagreement> rays = report.unexplained;
    rays.insert(rays.end(), report.explained.begin(), report.explained.end());
    return make_replay(scene.view(), std::move(rays));
}

TEST(RunReplay, RealDisagreementsReproduceWithAllTheGeometryOrTheConcernedAlone) {
    // Needles: embree and naive differ in t by more than 8 ulp often.
    for (const std::size_t count : {2000u, 12000u}) {
        Random random(224);
        const TestGeometry scene(needles(random, count, 1e-3f));
        const auto naive = make_intersector(AccelKind::naive, scene.view());
        const auto embree = make_intersector(AccelKind::embree, scene.view());
        Replay replay = disagreements(scene, *naive, *embree);
        replay.first = AccelKind::naive;
        replay.second = AccelKind::embree;
        ASSERT_GT(replay.rays.size(), 20u);
        EXPECT_EQ(replay.whole_geometry, count == 2000);
        EXPECT_LT(replay.primitives.size(), 2001u);
        std::ostringstream out;
        const ReplayOutcome outcome = run_replay(parse_replay(to_text(replay)), out);
        EXPECT_EQ(outcome.rays, replay.rays.size());
        EXPECT_EQ(outcome.reproduced, outcome.rays) << out.str();
        EXPECT_EQ(outcome.unexplained, 0u);
    }
}

TEST(RunReplay, ADefectThatIsNotThereAnyMoreDoesNotReproduce) {
    const TestGeometry scene = mixed_scene(225); // spheres, ids of several geometries
    const auto naive = make_intersector(AccelKind::naive, scene.view());
    const Defective broken(*naive, miss_always);
    Replay replay = disagreements(scene, *naive, broken);
    replay.first = AccelKind::naive;
    replay.second = AccelKind::sah;
    ASSERT_GT(replay.rays.size(), 1000u);
    replay.rays.resize(200);
    std::ostringstream out;
    const ReplayOutcome outcome = run_replay(replay, out);
    EXPECT_EQ(outcome.reproduced, 0u);
    EXPECT_EQ(outcome.unexplained, 0u);
    // The ids that it prints are the scene's: naive says again what the file says.
    const std::string text = out.str();
    EXPECT_NE(text.find("NOT reproduced with the whole geometry"), std::string::npos);
    EXPECT_NE(text.find("0 of 200 reproduced, 0 unexplained\n"), std::string::npos);
    std::size_t found = 0;
    for (const Disagreement& d : replay.rays) {
        std::ostringstream expected;
        expected.precision(9);
        expected << d.answers.first.geometry << ':' << d.answers.first.primitive << " t "
                 << d.answers.first.t;
        const std::size_t was = text.find(expected.str());
        found +=
            was != std::string::npos && text.find(expected.str(), was + 1) != std::string::npos;
    }
    EXPECT_EQ(found, 200u);
}

TEST(RunReplay, EmbreesLeaksAtCornersReproduceWithTheTrianglesAroundThem) {
    const TestGeometry scene(displaced_sphere({0, 0, 0}, 1, 60)); // too many to keep them all
    const auto naive = make_intersector(AccelKind::naive, scene.view());
    const auto embree = make_intersector(AccelKind::embree, scene.view());
    const ValidatingIntersector both(scene.view(), *naive, *embree);
    Random random(226);
    for (int i = 0; i < 20000; ++i) {
        const std::vector<Vec3>& corners = scene.meshes()[0].positions;
        const Vec3 target = corners[random.index(static_cast<std::uint32_t>(corners.size()))];
        const Vec3 origin = random.point(-0.1f, 0.1f);
        (void)static_cast<const Intersector&>(both).closest(
            Ray{origin, 0, target - origin, infinity});
    }
    const ValidationReport report = both.report();
    EXPECT_EQ(report.counts[static_cast<std::size_t>(Agreement::leak)][2],
              report.unexplained_count());
    ASSERT_GT(report.unexplained.size(), 5u);
    Replay replay = make_replay(scene.view(), report.unexplained);
    replay.first = AccelKind::naive;
    replay.second = AccelKind::embree;
    EXPECT_FALSE(replay.whole_geometry);
    std::ostringstream out;
    const ReplayOutcome outcome = run_replay(replay, out);
    EXPECT_EQ(outcome.reproduced, outcome.rays) << out.str();
    EXPECT_EQ(outcome.unexplained, outcome.rays) << out.str();
}

} // namespace
} // namespace plumb::test
