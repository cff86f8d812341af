/// \file  The benchmark's meshes, rays and arithmetic. The program: bench_command_test.py.
#include "tools/bench_src/catalogue.h"
#include "tools/bench_src/check.h"
#include "tools/bench_src/measure.h"
#include "tools/bench_src/structure.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>

namespace plumb::bench {
namespace {

BenchMesh mesh_called(std::string_view name, bool quick = true) {
    for (const CatalogueEntry& entry : catalogue())
        if (entry.name == name)
            return generate(entry, quick);
    ADD_FAILURE() << name;
    return {};
}

/// Every edge once in either direction: closed, and wound alike everywhere.
bool is_closed(const BenchMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const Triangle& t : mesh.triangles) {
        ++edges[{t.a, t.b}];
        ++edges[{t.b, t.c}];
        ++edges[{t.c, t.a}];
    }
    return std::all_of(edges.begin(), edges.end(), [&edges](const auto& edge) {
        const auto opposite = edges.find({edge.first.second, edge.first.first});
        return edge.second == 1 && opposite != edges.end() && opposite->second == 1;
    });
}

/// By the divergence theorem; positive where fronts are outside.
double volume(const BenchMesh& mesh) {
    double sum = 0;
    for (const Triangle& t : mesh.triangles)
        sum += static_cast<double>(
            dot(mesh.positions[t.a], cross(mesh.positions[t.b], mesh.positions[t.c])));
    return sum / 6;
}

TEST(BenchMeshes, HaveTheTrianglesTheyClaim) {
    // 8 n^2 for the closed surfaces of frequency n, strands times segments times two.
    const std::map<std::string_view, std::size_t> expected{{"cornell", 36},
                                                           {"teapot", 48'818},
                                                           {"needles", 60'000},
                                                           {"bunny-like", 69'192},
                                                           {"hall", 366'596},
                                                           {"hair", 20'000 * 21 * 2},
                                                           {"scan-like", 8 * 447 * 447},
                                                           {"terrain", 8 * 806 * 806}};
    ASSERT_EQ(catalogue().size(), expected.size());
    for (const CatalogueEntry& entry : catalogue())
        EXPECT_EQ(generate(entry, false).triangles.size(), expected.at(entry.name)) << entry.name;
}

TEST(BenchMeshes, AreFiniteAndIndexOnlyTheirOwnVertices) {
    for (const CatalogueEntry& entry : catalogue()) {
        const BenchMesh mesh = generate(entry, true);
        EXPECT_TRUE(std::all_of(mesh.positions.begin(), mesh.positions.end(), is_finite))
            << entry.name;
        for (const Triangle& t : mesh.triangles) {
            ASSERT_LT(std::max({t.a, t.b, t.c}), mesh.positions.size()) << entry.name;
            ASSERT_TRUE(t.a != t.b && t.b != t.c && t.c != t.a) << entry.name;
        }
    }
}

TEST(BenchMeshes, ClosedSurfacesAreClosedAndFaceOutwards) {
    for (const char* name : {"terrain", "bunny-like", "scan-like"}) {
        const BenchMesh mesh = mesh_called(name);
        EXPECT_TRUE(is_closed(mesh)) << name;
        // Radii within 0.3 of 1 on average: about a unit ball, 4.19.
        EXPECT_GT(volume(mesh), 2) << name;
        EXPECT_LT(volume(mesh), 8) << name;
    }
    BenchMesh open = mesh_called("terrain");
    open.triangles.pop_back();
    EXPECT_FALSE(is_closed(open));
}

// The bits are pinned: a result is comparable only with results of the same mesh. Whoever changes a
// generator changes these, and measures again.
TEST(BenchMeshes, HaveTheSameBitsOnEveryMachine) {
    const std::map<std::string_view, std::uint64_t> expected{
        {"cornell", 0xf2dd9c53c89ff235},   {"teapot", 0x5f829cdfd0f242b2},
        {"needles", 0x4886f658ff6bd184},   {"bunny-like", 0x5150572c81ea0d3e},
        {"hall", 0xe76082689deb3aeb},      {"hair", 0x214f75c10ae9d0e9},
        {"scan-like", 0xcbd1e0151f2c2c88}, {"terrain", 0x2acd1fecf06aabc1}};
    for (const CatalogueEntry& entry : catalogue())
        EXPECT_EQ(hash_of(generate(entry, true)), expected.at(entry.name))
            << entry.name << std::hex << " 0x" << hash_of(generate(entry, true));
}

/// The sets of a mesh, with the tree `kind` as the guide.
std::array<RaySet, ray_kinds.size()> sets_of(const BenchMesh& mesh, AccelKind kind) {
    const MeshView view = mesh.mesh_view();
    return make_ray_sets(mesh, *make_intersector(kind, {{&view, 1}, {}}));
}

bool same_ray(const Ray& a, const Ray& b) {
    return a.origin == b.origin && a.direction == b.direction && a.tmin == b.tmin &&
           a.tmax == b.tmax;
}

TEST(BenchRays, DependOnTheMeshAloneAndAreValid) {
    for (const CatalogueEntry& entry : catalogue()) {
        const BenchMesh mesh = generate(entry, true);
        const auto sets = sets_of(mesh, AccelKind::sah), again = sets_of(mesh, AccelKind::naive);
        for (std::size_t i = 0; i < sets.size(); ++i) {
            EXPECT_EQ(sets[i].kind, ray_kinds[i]);
            EXPECT_TRUE(std::equal(sets[i].rays.begin(), sets[i].rays.end(), again[i].rays.begin(),
                                   again[i].rays.end(), same_ray))
                << entry.name << " " << name_of(ray_kinds[i]);
            EXPECT_FALSE(sets[i].rays.empty()) << entry.name << " " << name_of(ray_kinds[i]);
            const bool segment = ray_kinds[i] == RayKind::shadow || ray_kinds[i] == RayKind::random;
            for (const Ray& ray : sets[i].rays)
                ASSERT_TRUE(is_valid(ray) && ray.tmin == 0 && ray.tmax == (segment ? 1 : infinity));
        }
    }
}

TEST(BenchRays, SixteenCameraRaysAreABlockOfFourByFourPixels) {
    BenchMesh mesh = mesh_called("cornell");
    const auto sets = sets_of(mesh, AccelKind::sah);
    const std::vector<Ray>& rays = sets[0].rays;
    ASSERT_EQ(rays.size() % 256, 0u);
    EXPECT_NEAR(static_cast<double>(rays.size()), static_cast<double>(mesh.coherent_rays), 256);
    // The camera looks along -z: pixels are steps of x / -z and y / -z.
    const float step = 2 * std::tan(mesh.view.fov_x_deg * (pi / 360)) / 1024;
    const auto pixel = [&](const Ray& ray) {
        return Vec2{ray.direction.x / -ray.direction.z / step,
                    -ray.direction.y / -ray.direction.z / step};
    };
    for (std::size_t first = 0; first < rays.size(); first += 16)
        for (std::size_t i = 0; i < 16; ++i) {
            const Vec2 corner = pixel(rays[first]), p = pixel(rays[first + i]);
            ASSERT_NEAR(p.x - corner.x, static_cast<float>(i % 4), 0.01f);
            ASSERT_NEAR(p.y - corner.y, static_cast<float>(i / 4), 0.01f);
        }
}

TEST(BenchRays, SecondaryRaysLeaveTheSurfaceTheyStartFrom) {
    // Inside a closed box: every ray of the second bounce hits, and none right where it starts.
    BenchMesh box = mesh_called("cornell");
    const auto sets = sets_of(box, AccelKind::sah);
    const MeshView view = box.mesh_view();
    const auto tree = make_intersector(AccelKind::naive, {{&view, 1}, {}});
    std::size_t close = 0;
    for (const Ray& ray : sets[3].rays)
        close += tree->closest(ray).t < 1e-4f ? 1u : 0u;
    EXPECT_LT(close, sets[3].rays.size() / 100);
}

TEST(BenchConfigs, GlobsSelectByName) {
    EXPECT_TRUE(matches_glob("sah/*", "sah/medium/avx2"));
    EXPECT_TRUE(matches_glob("*", ""));
    EXPECT_TRUE(matches_glob("*/m*/*", "sah/medium/avx2"));
    EXPECT_FALSE(matches_glob("sah", "sah/medium"));
    EXPECT_FALSE(matches_glob("*x", "sah"));
    const std::vector<Config> configs = all_configs(1);
    for (const Config& config : configs)
        EXPECT_EQ(1, std::count_if(configs.begin(), configs.end(),
                                   [&](const Config& c) { return c.name == config.name; }))
            << config.name;
}

TEST(BenchCheck, CountsWhatDiffers) {
    const Hit hit{1, 0.25f, 0.5f, 0, 7, invalid_id};
    Hit ulp = hit, far = hit, other = hit;
    ulp.t = std::nextafter(1.0f, 2.0f);
    far.t = 1.001f;
    other.primitive = 8;
    const std::vector<Hit> reference(5, hit), hits{hit, ulp, far, other, Hit{}};
    EXPECT_EQ(different_bits(hits, reference), 4u);
    EXPECT_EQ(far_apart(hits, reference), 2u); // far, and the miss
    EXPECT_EQ(far_apart(std::vector<Hit>{Hit{}}, std::vector<Hit>{Hit{}}), 0u);
}

TEST(BenchResults, SummaryIsTheGeometricMeanAndTheLeastOfTheRatios) {
    const auto cell = [](const char* mesh, double own) {
        Cell c;
        c.mesh = mesh;
        c.entries = {{"embree/medium/default", true, false, false, {4, 1, 2}, 0, {}},
                     {"embree/high/default", true, false, false, {1}, 0, {}},
                     {"embree/medium/robust", true, true, false, {1, 1}, 0, {}},
                     {"embree/medium/default/packet16", true, false, true, {8}, 0, {}},
                     {"sah/stream", false, true, true, {own}, 0, {}}};
        return c;
    };
    MeshResult a, b;
    a.name = "a";
    b.name = "b";
    a.cells = {cell("a", 2)};
    b.cells = {cell("b", 8)};
    const auto rows = summary_of({a, b});
    ASSERT_EQ(rows.size(), 1u);
    ASSERT_TRUE(rows[0].to_default && rows[0].to_robust && rows[0].to_packet);
    EXPECT_DOUBLE_EQ(rows[0].to_default->geometric_mean, 2); // sqrt(2/2 * 8/2)
    EXPECT_DOUBLE_EQ(rows[0].to_robust->geometric_mean, 4);
    EXPECT_DOUBLE_EQ(rows[0].to_packet->geometric_mean, 0.5);
    EXPECT_DOUBLE_EQ(rows[0].to_default->least, 1);
    EXPECT_EQ(rows[0].to_default->least_mesh, "a");
    EXPECT_EQ(median_of({3, 1, 2, 10}), 2.5);
    EXPECT_FALSE(ratio_of(1, 0));
}

TEST(BenchStructure, EveryWayOfTracingGivesTheAnswersItWasCheckedWith) {
    const BenchMesh mesh = mesh_called("hall");
    const MeshView view = mesh.mesh_view();
    const auto sets = sets_of(mesh, AccelKind::sah);
    for (const Config& config : all_configs(1, RaySide::host)) {
        Structure structure(config.structure, {{&view, 1}, {}});
        structure.build();
        for (const RaySet& rays : sets) {
            const auto prepared = structure.prepare(rays, config.wide);
            std::vector<Hit> hits(rays.rays.size());
            const std::uint64_t checksum = structure.answers(prepared, hits);
            EXPECT_EQ(structure.trace(prepared).checksum, checksum) << config.name;
            EXPECT_TRUE(std::any_of(hits.begin(), hits.end(), [](const Hit& hit) {
                return hit.valid();
            })) << config.name;
        }
    }
}

TEST(BenchStructure, PacketsAndSingleRaysOfEmbreeGiveTheSameAnswers) {
    const BenchMesh mesh = mesh_called("teapot");
    const MeshView view = mesh.mesh_view();
    auto sets = sets_of(mesh, AccelKind::sah);
    sets[0].rays.resize(sets[0].rays.size() - 5); // a packet that is not full
    StructureConfig config;
    config.accel = AccelKind::embree;
    Structure structure(config, {{&view, 1}, {}});
    structure.build();
    for (const RaySet& rays : {sets[0], sets[1]}) {
        std::vector<Hit> single(rays.rays.size()), packets = single;
        static_cast<void>(structure.answers(structure.prepare(rays, false), single));
        static_cast<void>(structure.answers(structure.prepare(rays, true), packets));
        EXPECT_LE(far_apart(packets, single), rays.rays.size() / 1000) << name_of(rays.kind);
    }
}

} // namespace
} // namespace plumb::bench
