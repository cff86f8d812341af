/// \file  Invariants, cost and determinism of the binary trees of every quality.

#include "accel/naive/build_naive.h"
#include "accel/sah/build_binary.h"
#include "accel/sah/check_binary.h"
#include "accel/sah/clip_triangle.h"
#include "accel/sah/reinsertion.h"
#include "accel/sah/sah_cost.h"
#include "tests/support/hard_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace plumb::test {
namespace {

constexpr BuildQuality qualities[]{BuildQuality::fast, BuildQuality::medium, BuildQuality::high};

BinaryBvh build(const GeometryView& view, BuildQuality quality, int threads = 1) {
    BinaryBuildOptions options;
    options.quality = quality;
    options.threads = threads;
    return build_binary(view, options);
}

/// Under the model that the builder minimises, relative to the root's area.
double model_cost(const BinaryBvh& tree) {
    double cost = 0;
    for (const BinaryNode& node : tree.nodes)
        cost +=
            surface_area(node.bounds) * (node.is_leaf() ? leaf_cost(node.count) : traversal_cost);
    return cost / surface_area(tree.nodes[0].bounds);
}

double model_cost(const NaiveTree& tree) {
    double cost = 0;
    for (const NaiveNode& node : tree.nodes)
        cost += surface_area(node.bounds) * (node.is_leaf() ? leaf_cost(1) : traversal_cost);
    return cost / surface_area(tree.nodes[0].bounds);
}

double mean_leaf_size(const BinaryBvh& tree) {
    const auto leaves = std::count_if(tree.nodes.begin(), tree.nodes.end(),
                                      [](const BinaryNode& node) { return node.is_leaf(); });
    return static_cast<double>(tree.primitives.size()) / static_cast<double>(leaves);
}

bool same_bits(const BinaryBvh& a, const BinaryBvh& b) {
    return a.nodes.size() == b.nodes.size() && a.primitives == b.primitives && a.depth == b.depth &&
           a.primitive_count == b.primitive_count && a.skipped_count == b.skipped_count &&
           (a.nodes.empty() ||
            std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(BinaryNode)) == 0);
}

TEST(BuildBinary, KeepsItsInvariantsOnHardScenes) {
    for (const NamedScene& scene : hard_scenes())
        for (const BuildQuality quality : qualities) {
            const GeometryView view = scene.geometry.view();
            EXPECT_EQ(check_binary(build(view, quality), view), "")
                << scene.name << ", " << name_of(quality);
        }
}

TEST(BuildBinary, IsTheSameForAnyNumberOfThreads) {
    std::vector<NamedScene> scenes = hard_scenes();
    scenes.push_back({"large", TestGeometry(displaced_sphere({1, 2, 3}, 1, 200))});
    for (const NamedScene& scene : scenes)
        for (const BuildQuality quality : qualities) {
            const GeometryView view = scene.geometry.view();
            const BinaryBvh one = build(view, quality, 1);
            for (const int threads : {0, 2, 3, 8})
                EXPECT_TRUE(same_bits(one, build(view, quality, threads)))
                    << scene.name << ", " << name_of(quality) << ", " << threads;
        }
}

TEST(BuildBinary, MoreQualityCostsNoMore) {
    // The median split of the naive tree bounds them all. Greedy choices have no guarantee among
    // themselves: a split that is better here, on another axis or of space, can be worse further
    // down.
    for (const NamedScene& scene : hard_scenes()) {
        const GeometryView view = scene.geometry.view();
        const NaiveTree naive = build_naive(view);
        if (naive.nodes.empty() || surface_area(naive.nodes[0].bounds) == 0)
            continue;
        const double fast = model_cost(build(view, BuildQuality::fast));
        const double medium = model_cost(build(view, BuildQuality::medium));
        const double high = model_cost(build(view, BuildQuality::high));
        EXPECT_LE(fast, model_cost(naive) * (1 + 1e-9)) << scene.name;
        EXPECT_LE(medium, 1.05 * fast) << scene.name;
        EXPECT_LE(high, 1.001 * medium) << scene.name;
    }
}

/// Two flat layers, longer than they are apart: the best split is between them, the widest axis
/// runs along them.
TEST(BuildBinary, FastSplitsAcrossTheWidestAxisOnly) {
    std::vector<Vec3> positions;
    std::vector<Triangle> triangles;
    Random random(7);
    for (std::uint32_t i = 0; i < 400; ++i) {
        const Vec3 at{random.uniform(0, 10), i % 2 == 0 ? 0.0f : 5.0f, random.uniform(0, 4)};
        triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        for (const Vec3 corner : {Vec3{0, 0, 0}, Vec3{0.1f, 0, 0}, Vec3{0, 0.1f, 0.1f}})
            positions.push_back(at + corner);
    }
    const MeshView mesh{positions, triangles};
    const auto overlap = [&](BuildQuality quality, int axis) {
        const BinaryBvh tree = build({{&mesh, 1}, {}}, quality);
        const Bounds a = tree.nodes[tree.nodes[0].first].bounds;
        const Bounds b = tree.nodes[tree.nodes[0].first + 1].bounds;
        return std::min(a.upper[axis], b.upper[axis]) > std::max(a.lower[axis], b.lower[axis]) + 1;
    };
    EXPECT_TRUE(overlap(BuildQuality::fast, 1));
    EXPECT_FALSE(overlap(BuildQuality::fast, 0));
    EXPECT_FALSE(overlap(BuildQuality::medium, 1));
    EXPECT_TRUE(overlap(BuildQuality::medium, 0));
}

TEST(BuildBinary, FillsItsLeaves) {
    // 320 bytes a leaf of the wide layout: 6 of 8 keep the tree below 70 bytes a triangle.
    const TestGeometry scene(displaced_sphere({0, 0, 0}, 1, 160));
    for (const BuildQuality quality : {BuildQuality::fast, BuildQuality::medium})
        EXPECT_GE(mean_leaf_size(build(scene.view(), quality)), 7) << name_of(quality);
}

TEST(BuildBinary, AgreesWithItselfAtAnyScale) {
    // Powers of two change no mantissa, and areas neither overflow nor vanish: the same decisions.
    Random random(131);
    const Mesh mesh = triangle_soup(random, 3000, 0.1f);
    const TestGeometry unit{Mesh(mesh)};
    for (const BuildQuality quality : {BuildQuality::fast, BuildQuality::medium}) {
        const BinaryBvh expected = build(unit.view(), quality);
        for (const int exponent : {-80, -30, 30, 59}) {
            Mesh scaled = mesh;
            for (Vec3& p : scaled.positions)
                p = std::ldexp(1.0f, exponent) * p;
            const TestGeometry scene(std::move(scaled));
            const BinaryBvh tree = build(scene.view(), quality);
            EXPECT_EQ(tree.primitives, expected.primitives) << exponent;
            EXPECT_NEAR(model_cost(tree), model_cost(expected), 1e-6) << exponent;
        }
    }
}

TEST(BuildBinary, TakesGarbageAsItComes) {
    // Any bit pattern as a coordinate: what is not traceable is left out, the rest is found. In two
    // scenes of three the exponents are such that most are traceable.
    Random random(132);
    for (int scene = 0; scene < 300; ++scene) {
        Mesh mesh;
        const std::size_t count = 1 + random.index(200);
        for (std::size_t i = 0; i < count; ++i) {
            const auto any = [&] {
                const std::uint32_t exponents = scene % 3 == 0 ? 0xffffffffu : 0xbfffffffu;
                return std::bit_cast<float>(random.bits() & exponents);
            };
            mesh.add_triangle({any(), any(), any()}, {any(), any(), any()}, {any(), any(), any()});
        }
        const TestGeometry geometry(std::move(mesh));
        for (const BuildQuality quality : qualities) {
            const std::string wrong =
                check_binary(build(geometry.view(), quality), geometry.view());
            ASSERT_EQ(wrong, "") << scene << ", " << name_of(quality);
        }
    }
}

/// Long boards, level and upright, in all directions of the compass, around a small sphere.
Mesh boards(std::uint64_t seed, int count) {
    Random random(seed);
    Mesh mesh = displaced_sphere({20, 20, 5}, 2, 12);
    for (int i = 0; i < count; ++i) {
        const Vec3 a{random.uniform(0, 40), random.uniform(0, 40), random.uniform(0, 10)};
        const float angle = random.uniform(0, 2 * pi), length = random.uniform(1, 9);
        const Vec3 along{length * std::cos(angle), length * std::sin(angle), random.uniform(0, 1)};
        const Vec3 across =
            i % 2 == 0 ? Vec3{0, 0, 0.3f} : 0.08f * Vec3{-along.y, along.x, 0} / length;
        mesh.add_triangle(a, a + along, a + along + across);
        mesh.add_triangle(a, a + along + across, a + across);
    }
    return mesh;
}

TEST(SpatialSplits, LowerTheCostWithinTheirBudget) {
    const TestGeometry scene(boards(134, 4000));
    const double medium = model_cost(build(scene.view(), BuildQuality::medium));
    double before = medium;
    for (const float duplication : {0.1f, 0.3f, 1.0f}) {
        BinaryBuildOptions options;
        options.quality = BuildQuality::high;
        options.duplication = duplication;
        const BinaryBvh tree = build_binary(scene.view(), options);
        EXPECT_EQ(check_binary(tree, scene.view()), "");
        const auto count = static_cast<double>(tree.primitive_count);
        const auto references = static_cast<double>(tree.primitives.size());
        EXPECT_LE(references, (1 + static_cast<double>(duplication)) * count);
        EXPECT_GT(references, 1.05 * count);
        EXPECT_LT(model_cost(tree), before) << duplication;
        before = model_cost(tree);
    }
    EXPECT_LT(before, 0.8 * medium);
    BinaryBuildOptions none;
    none.quality = BuildQuality::high;
    none.duplication = 0;
    EXPECT_EQ(build_binary(scene.view(), none).primitives.size(), scene.view().primitive_count());
}

TEST(SpatialSplits, CutBoxesContainTheTriangleWhereItIs) {
    // Points of the triangle lie, on each side of the plane, within that side's box, with the
    // margin that triangle_bounds gives; the parts lie within the box.
    Random random(135);
    int cut = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 offset = random.point(-100, 100);
        const TriangleVertices t{offset + random.point(-1, 1), offset + random.point(-1, 1),
                                 offset + random.point(-1, 1)};
        const Bounds own = triangle_bounds(t.a, t.b, t.c);
        const int axis = i % 3;
        const float plane =
            random.index(4) == 0 ? t.b[axis] : random.uniform(own.lower[axis], own.upper[axis]);
        const ClipTriangle triangle(t, float4::broadcast(1));
        if (!triangle.can_be_cut())
            continue;
        Box below, above;
        triangle.cut(axis, plane, {float4::load(own.lower), float4::load(own.upper)}, below, above);
        const Bounds parts[2]{below.bounds(), above.bounds()};
        for (const Bounds& part : parts)
            EXPECT_TRUE(part.empty() || own.contains(part));
        cut += parts[0].empty() || parts[1].empty() ? 0 : 1;
        const float margin = 8 * unit_roundoff * max_component(own.extent());
        for (int k = 0; k < 20; ++k) {
            const Vec2 u = random.square();
            const float b = std::min(u.x, u.y), c = std::max(u.x, u.y) - b;
            const Vec3 point = (1 - b - c) * t.a + b * t.b + c * t.c;
            const Bounds around = triangle_bounds(point, point, point);
            const Bounds& part = parts[point[axis] <= plane ? 0 : 1];
            const Vec3 m{margin, margin, margin};
            const Bounds wanted{max(own.lower, around.lower - m), min(own.upper, around.upper + m)};
            EXPECT_TRUE(part.contains(wanted)) << i;
        }
    }
    EXPECT_GT(cut, 10000);
}

/// The leaves of each triangle.
std::vector<std::vector<Bounds>> boxes_by_primitive(const BinaryBvh& tree, std::size_t count) {
    std::vector<std::vector<Bounds>> boxes(count);
    for (const BinaryNode& node : tree.nodes)
        for (std::uint32_t i = 0; i < node.count; ++i)
            boxes[tree.primitives[node.first + i]].push_back(node.bounds);
    return boxes;
}

TEST(SpatialSplits, EveryHitIsInALeafThatTheRayMeets) {
    // Rays aimed at where leaves' boxes cut their triangles, from near and far: a triangle that the
    // test finds must be in a leaf that overlaps(slab_interval) enters at or before the hit.
    const TestGeometry scene(boards(136, 4000));
    const GeometryView view = scene.view();
    const auto boxes = boxes_by_primitive(build(view, BuildQuality::high), view.primitive_count());
    Random random(137);
    int hits = 0, lost = 0;
    for (std::uint32_t p = 0; p < boxes.size(); ++p) {
        if (boxes[p].size() < 2)
            continue;
        const TriangleVertices t = view.vertices(0, p);
        const auto point_in = [&] {
            const Vec2 u = random.square();
            const float b = std::min(u.x, u.y), c = std::max(u.x, u.y) - b;
            return (1 - b - c) * t.a + b * t.b + c * t.c;
        };
        for (int k = 0; k < 400; ++k) {
            const Bounds& box = boxes[p][random.index(static_cast<std::uint32_t>(boxes[p].size()))];
            const int axis = static_cast<int>(random.index(3));
            const float plane = random.index(2) == 0 ? box.lower[axis] : box.upper[axis];
            const Vec3 from = point_in(), to = point_in();
            const float s = (plane - from[axis]) / (to[axis] - from[axis]);
            const Vec3 target = s >= 0 && s <= 1 ? from + s * (to - from) : from;
            const float distance = std::ldexp(1.0f, static_cast<int>(random.index(20)) - 6);
            const Vec3 direction = random.direction();
            const Ray ray{target - distance * direction, 0, direction, infinity};
            const PreparedRay prepared(ray);
            PrimitiveHit hit;
            if (!intersect_triangle(prepared, t.a, t.b, t.c, infinity, hit))
                continue;
            ++hits;
            lost += std::none_of(boxes[p].begin(), boxes[p].end(), [&](const Bounds& b) {
                return overlaps(slab_interval(prepared.slab, b), 0, hit.t * slab_padding);
            });
        }
    }
    EXPECT_GT(hits, 100000);
    EXPECT_EQ(lost, 0);
}

TEST(Reinsertion, MakesATreeCheaperAndKeepsItWhole) {
    const TestGeometry scene = mixed_scene(138);
    const GeometryView view = scene.view();
    const PrimitiveNumbers numbers(view);
    const BinaryBvh before = build(view, BuildQuality::medium);
    for (const int passes : {1, 3, 20})
        for (const float fraction : {0.01f, 0.5f, 1.0f}) {
            BinaryBvh tree = before;
            optimize_by_reinsertion(tree, {passes, fraction}, numbers.first_sphere(), Workers(2));
            EXPECT_EQ(check_binary(tree, view), "") << passes << ", " << fraction;
            EXPECT_LE(model_cost(tree), model_cost(before));
            if (fraction == 1) {
                EXPECT_LT(model_cost(tree), 0.99 * model_cost(before));
            }
        }
}

TEST(Reinsertion, FindsThePlaceOfALeafThatWasMisplaced) {
    // Four clusters of eight; the tree pairs the left with the right ones. Reinsertion puts
    // together what is together: two leaves left, two right.
    Mesh mesh;
    for (const float x : {0.0f, 1.5f, 100.0f, 101.5f})
        for (int i = 0; i < 8; ++i)
            mesh.add_triangle({x, 0, 0}, {x + 1, 0, 0}, {x, 1, 1});
    const TestGeometry scene(std::move(mesh));
    BinaryBvh tree;
    tree.primitive_count = 32;
    tree.depth = 2;
    for (PrimitiveNumber i = 0; i < 32; ++i)
        tree.primitives.push_back(i);
    const auto cluster = [&](std::uint32_t i) {
        Bounds bounds;
        for (std::uint32_t k = 0; k < 8; ++k)
            bounds.extend(primitive_bounds(scene.view(), 0, 8 * i + k));
        return BinaryNode{bounds, 8 * i, 8};
    };
    const auto both = [](const BinaryNode& a, const BinaryNode& b, std::uint32_t first) {
        Bounds bounds = a.bounds;
        bounds.extend(b.bounds);
        return BinaryNode{bounds, first, 0};
    };
    const BinaryNode a = cluster(0), b = cluster(2), c = cluster(1), d = cluster(3);
    const BinaryNode left = both(a, b, 3), right = both(c, d, 5);
    tree.nodes = {both(left, right, 1), left, right, a, b, c, d};
    ASSERT_EQ(check_binary(tree, scene.view()), "");
    optimize_by_reinsertion(tree, {5, 1}, 32, Workers(1));
    EXPECT_EQ(check_binary(tree, scene.view()), "");
    for (const std::uint32_t child : {1u, 2u})
        EXPECT_LT(tree.nodes[child].bounds.extent().x, 3) << child;
}

TEST(CheckBinary, SeesADamagedTree) {
    const TestGeometry scene = mixed_scene(133);
    const BinaryBvh whole = build(scene.view(), BuildQuality::medium);
    ASSERT_EQ(check_binary(whole, scene.view()), "");
    const auto leaf = static_cast<std::size_t>(
        std::find_if(whole.nodes.begin(), whole.nodes.end(),
                     [](const BinaryNode& node) { return node.count > 1; }) -
        whole.nodes.begin());
    const auto damaged = [&](auto&& damage) {
        BinaryBvh tree = whole;
        damage(tree);
        return check_binary(tree, scene.view());
    };
    EXPECT_EQ(damaged([&](BinaryBvh& t) { t.nodes[leaf].bounds.upper.x += 100; }),
              "a box does not contain its child's box");
    EXPECT_EQ(damaged([&](BinaryBvh& t) { t.nodes[0].bounds.upper.x += 1; }),
              "a box is larger than its children need");
    const TestGeometry other = mixed_scene(139); // as many of everything, elsewhere
    EXPECT_EQ(check_binary(whole, other.view()),
              "the boxes of a primitive's leaves do not contain its box");
    EXPECT_EQ(damaged([&](BinaryBvh& t) {
                  std::swap(t.primitives[t.nodes[leaf].first],
                            t.primitives[t.nodes[leaf].first + 1]);
              }),
              "the primitives of a leaf do not ascend");
    EXPECT_EQ(damaged([&](BinaryBvh& t) { --t.nodes[leaf].count; }),
              "a node or a place in the list is not used");
    EXPECT_EQ(damaged([&](BinaryBvh& t) { ++t.skipped_count; }),
              "primitive_count or skipped_count is wrong");
    EXPECT_EQ(damaged([&](BinaryBvh& t) { ++t.depth; }), "depth is wrong");
    EXPECT_EQ(damaged([&](BinaryBvh& t) { t.nodes[0].first = t.nodes[1].first; }),
              "a box is larger than its children need");
}

} // namespace
} // namespace plumb::test
