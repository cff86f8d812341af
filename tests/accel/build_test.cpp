/// \file  Tree invariants of the naive and the SAH tree, depth and leaf limits, SAH cost.

#include "accel/naive/build_naive.h"
#include "accel/naive/check_tree.h"
#include "accel/sah/build_sah.h"
#include "accel/sah/check_tree.h"
#include "accel/sah/sah_cost.h"
#include "tests/accel/intersector_suite.h"
#include "tests/support/hard_scenes.h"

#include <algorithm>
#include <cmath>

namespace plumb::test {
namespace {

int ceil_log2(std::size_t n) {
    int bits = 0;
    while ((std::size_t{1} << bits) < n)
        ++bits;
    return bits;
}

TEST(BuildNaive, KeepsItsInvariantsOnHardScenes) {
    for (const NamedScene& scene : hard_scenes()) {
        const GeometryView view = scene.geometry.view();
        const NaiveTree tree = build_naive(view);
        EXPECT_EQ(check_tree(tree, view), "") << scene.name;
        const AccelStats stats = make_intersector(AccelKind::naive, view)->stats();
        EXPECT_EQ(stats.primitive_count + stats.skipped_count, view.primitive_count())
            << scene.name;
        // Median split by count: balanced whatever the positions are.
        EXPECT_LE(stats.depth, ceil_log2(std::max<std::size_t>(1, stats.primitive_count)))
            << scene.name;
        EXPECT_EQ(stats.leaf_count, stats.primitive_count) << scene.name;
    }
}

TEST(BuildSah, KeepsItsInvariantsOnHardScenes) {
    for (const NamedScene& scene : hard_scenes()) {
        const GeometryView view = scene.geometry.view();
        const SahTree tree = build_sah(view);
        EXPECT_EQ(check_tree(tree.view(), view), "") << scene.name;
        EXPECT_LE(tree.depth, 64) << scene.name;
        EXPECT_EQ(tree.primitive_count + tree.skipped_count, view.primitive_count()) << scene.name;
        EXPECT_LE(tree.primitive_count, 8 * tree.leaf_count) << scene.name << ": leaf <= 8";
    }
}

TEST(BuildSah, CheckTreeSeesADamagedTree) {
    const TestGeometry scene = mixed_scene(123);
    const SahTree whole = build_sah(scene.view());
    ASSERT_EQ(check_tree(whole.view(), scene.view()), "");
    SahTree tree = whole;
    for (auto& axis : tree.nodes[0].planes) // a box that is too small
        axis[2] = axis[0];
    EXPECT_NE(check_tree(tree.view(), scene.view()), "");
    tree = whole;
    tree.blocks[0].primitive[0] += 1; // a primitive twice, another not at all
    EXPECT_NE(check_tree(tree.view(), scene.view()), "");
    tree = whole;
    tree.nodes[0].child[1] = tree.nodes[0].child[0]; // half the tree twice
    EXPECT_NE(check_tree(tree.view(), scene.view()), "");
}

TEST(BuildNaive, CheckTreeSeesADamagedTree) {
    const TestGeometry scene = mixed_scene(123);
    const NaiveTree whole = build_naive(scene.view());
    ASSERT_EQ(check_tree(whole, scene.view()), "");
    NaiveTree tree = whole;
    tree.nodes[0].bounds.upper = tree.nodes[0].bounds.lower;
    EXPECT_NE(check_tree(tree, scene.view()), "");
    tree = whole;
    tree.nodes[0].left = tree.nodes[0].right;
    EXPECT_NE(check_tree(tree, scene.view()), "");
}

/// Cost of the naive tree under the model that the SAH builder minimises (binned_split.h), relative
/// to the root's area.
double model_cost(const NaiveTree& tree) {
    double cost = 0;
    for (const NaiveNode& node : tree.nodes)
        cost += surface_area(node.bounds) * (node.is_leaf() ? leaf_cost(1) : traversal_cost);
    return cost / surface_area(tree.nodes[0].bounds);
}

double model_cost(const SahTree& tree) {
    Bounds root = tree.nodes[0].bounds(0);
    root.extend(tree.nodes[0].bounds(1));
    double cost = tree.inner_count > 0 ? traversal_cost * surface_area(root) : 0;
    for (const SahNode& node : tree.nodes)
        for (int i = 0; i < 2; ++i)
            cost += surface_area(node.bounds(i)) *
                    (node.child[i].is_leaf() ? leaf_cost(node.child[i].count()) : traversal_cost);
    return cost / surface_area(root);
}

TEST(BuildSah, CostsAtMostAsMuchAsTheMedianSplit) {
    // Leaves are tested as blocks of eight lanes, so the cost of a leaf is that of a block and not
    // the number of its triangles; under this model, for both trees.
    for (const NamedScene& scene : hard_scenes()) {
        const GeometryView view = scene.geometry.view();
        const NaiveTree naive = build_naive(view);
        if (naive.nodes.empty() || surface_area(naive.nodes[0].bounds) == 0)
            continue;
        EXPECT_LE(model_cost(build_sah(view)), model_cost(naive) * (1 + 1e-9)) << scene.name;
    }
}

TEST(BuildSah, CostIsWhatTheFormulaSays) {
    // Two far clusters of 8 coincident unit right triangles: root C_t plus two leaves of 8 weighted
    // by their area over the root's. The boxes are flat: unit squares 100 apart.
    Mesh mesh;
    for (const float z : {0.0f, 100.0f})
        for (int i = 0; i < 8; ++i)
            mesh.add_triangle({0, 0, z}, {1, 0, z}, {0, 1, z});
    const TestGeometry scene(std::move(mesh));
    const AccelStats stats = make_intersector(AccelKind::sah, scene.view())->stats();
    const double root = 2 * (1 + 100 + 100), leaf = 2;
    // 1e-4: boxes are rounded outwards.
    EXPECT_NEAR(stats.sah_cost, 1 + 2 * 8 * leaf / root, 1e-4);
    EXPECT_EQ(stats.leaf_count, 2u);
    EXPECT_EQ(stats.depth, 1);
}

TEST(BuildSah, IsDeterministic) {
    const TestGeometry scene = mixed_scene(124);
    const SahTree a = build_sah(scene.view()), b = build_sah(scene.view());
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    EXPECT_EQ(std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(SahNode)), 0);
    ASSERT_EQ(a.blocks.size(), b.blocks.size());
    for (std::size_t i = 0; i < a.blocks.size(); ++i)
        EXPECT_TRUE(std::equal(std::begin(a.blocks[i].primitive), std::end(a.blocks[i].primitive),
                               std::begin(b.blocks[i].primitive)));
}

TEST(DeepTrees, AreTracedToTheBottom) {
    // What a fixed traversal stack overflows on; the address sanitizer watches.
    for (const NamedScene& scene : hard_scenes()) {
        const GeometryView view = scene.geometry.view();
        Random random(125);
        for (const AccelKind kind : {AccelKind::naive, AccelKind::sah}) {
            const auto accel = make_intersector(kind, view);
            int differ = 0;
            for (int i = 0; i < 200; ++i) {
                const Vec3 d = random.direction();
                const Ray ray{1e-3f * random.point(-1, 1), 0, d, infinity};
                differ += accel->occluded(ray) != accel->closest(ray).valid();
            }
            EXPECT_EQ(differ, 0) << scene.name;
        }
    }
}

TEST(DeepTrees, ARayThroughNestedBoxesMeetsEachWallInTurn) {
    const TestGeometry scene(nested_boxes(1000));
    for (const AccelKind kind : {AccelKind::naive, AccelKind::sah, AccelKind::embree}) {
        const auto accel = make_intersector(kind, scene.view());
        Ray ray{{0.1f, 0.2f, 0}, 0, {0, 0, 1}, infinity};
        for (int i = 1; i <= 1000; ++i) {
            const Hit hit = accel->closest(ray);
            ASSERT_TRUE(hit.valid()) << i;
            ASSERT_NEAR(static_cast<double>(hit.t), i, 1e-4 * i);
            ASSERT_EQ(hit.primitive / 12, static_cast<std::uint32_t>(i - 1));
            ray.tmin = hit.t;
        }
        EXPECT_FALSE(accel->closest(ray).valid());
    }
}

} // namespace
} // namespace plumb::test
