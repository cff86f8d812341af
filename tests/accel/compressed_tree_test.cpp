/// \file  The compressed tree: its invariants, its boxes, its order, its size, and the bits of its
/// hits.

#include "accel/sah/build_binary.h"
#include "accel/sah/build_compressed.h"
#include "accel/sah/check_compressed.h"
#include "accel/sah/compress_node.h"
#include "accel/sah/split_leaves.h"
#include "tests/accel/intersector_suite.h"
#include "tests/support/hard_scenes.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace plumb::test {
namespace {

TEST(CompressedTree, KeepsItsInvariantsOnHardScenes) {
    for (const NamedScene& scene : hard_scenes()) {
        const GeometryView view = scene.geometry.view();
        const CompressedTree tree = build_compressed(view);
        EXPECT_EQ(check_compressed(tree.view(), view), "") << scene.name;
        EXPECT_EQ(tree.primitive_count + tree.skipped_count, view.primitive_count()) << scene.name;
        EXPECT_LE(tree.depth, compressed_max_depth) << scene.name;
    }
}

TEST(CompressedTree, IsTheSameBytesForAnyNumberOfThreads) {
    const TestGeometry scene = mixed_scene(131);
    const CompressedTree one = build_compressed(scene.view(), 1);
    for (const int threads : {2, 5}) {
        const CompressedTree other = build_compressed(scene.view(), threads);
        ASSERT_EQ(one.nodes.size(), other.nodes.size());
        EXPECT_EQ(std::memcmp(one.nodes.data(), other.nodes.data(),
                              one.nodes.size() * sizeof(CompressedNode)),
                  0);
    }
}

TEST(CompressedTree, TakesNoMoreBytesATriangleThanThePaper) {
    // The paper's trees take 16 to 28 bytes of nodes a triangle, and 48 the triangle itself.
    const TestGeometry scene(displaced_sphere({0, 0, 0}, 1, 160));
    const auto triangles = static_cast<double>(scene.view().primitive_count());
    const CompressedTree tree = build_compressed(scene.view());
    const double nodes = static_cast<double>(tree.nodes.size() * sizeof(CompressedNode));
    EXPECT_LT(nodes / triangles, 28);
    EXPECT_LT(static_cast<double>(tree.stats().bytes) / triangles, 76);
    EXPECT_EQ(tree.primitives.size() * sizeof(CompressedPrimitive) +
                  tree.nodes.size() * sizeof(CompressedNode),
              tree.stats().bytes);
}

struct Damage {
    const char* what;
    std::function<void(CompressedTree&)> apply;
    const char* expected;
};

TEST(CompressedTree, CheckSeesADamagedTree) {
    const std::vector<Damage> damages{
        {"a box that is too small",
         [](CompressedTree& t) { t.nodes[0].upper[1][0] = t.nodes[0].upper[1][1] = 0; }, "contain"},
        {"a step that is too small", [](CompressedTree& t) { --t.nodes[0].exponents; }, "contain"},
        {"a lost leaf",
         [](CompressedTree& t) { t.nodes.back().meta[0] = t.nodes.back().meta[1] = 0; }, "reached"},
        {"a node in a wrong slot", [](CompressedTree& t) { t.nodes[0].exponents ^= 1u << 24; },
         "contradict"},
        {"children elsewhere", [](CompressedTree& t) { t.nodes[0].first_child = 0; }, "deeper"},
        {"another triangle's vertices", [](CompressedTree& t) { t.primitives[0].b.y += 1; },
         "differs"},
        {"another id", [](CompressedTree& t) { t.primitives[0].primitive ^= 1u; }, ""},
        {"a sphere that is none", [](CompressedTree& t) { t.primitives[0].is_sphere ^= 1u; },
         "kind"},
        {"a reach that is too small", [](CompressedTree& t) { t.reach *= 0.5f; }, "reach"},
    };
    const TestGeometry scene = mixed_scene(132);
    for (const Damage& damage : damages) {
        CompressedTree tree = build_compressed(scene.view());
        ASSERT_EQ(check_compressed(tree.view(), scene.view()), "");
        damage.apply(tree);
        const std::string wrong = check_compressed(tree.view(), scene.view());
        EXPECT_NE(wrong, "") << damage.what;
        EXPECT_NE(wrong.find(damage.expected), std::string::npos) << damage.what << ": " << wrong;
    }
}

TEST(SplitLeaves, LeavesOnePrimitiveALeafWithinTheSameBoxes) {
    for (const NamedScene& scene : hard_scenes()) {
        const GeometryView view = scene.geometry.view();
        const BinaryBvh before = build_binary(view);
        const BinaryBvh after = split_leaves(before, view);
        EXPECT_LE(after.depth, before.depth + 7) << scene.name;
        std::size_t leaves = 0;
        for (const BinaryNode& node : after.nodes) {
            leaves += node.is_leaf();
            EXPECT_LE(node.count, 1u) << scene.name;
            for (std::uint32_t i = 0; i < (node.is_leaf() ? 0u : 2u); ++i)
                EXPECT_TRUE(node.bounds.contains(after.nodes[node.first + i].bounds)) << scene.name;
        }
        EXPECT_EQ(leaves, before.primitives.size()) << scene.name;
    }
}

TEST(CompressNode, DecodedBoxesContainTheGivenOnesAndAreNoLooserThanTwoSteps) {
    Random random(133);
    for (int i = 0; i < 100000; ++i) {
        const float scale = std::ldexp(1.0f, static_cast<int>(random.index(160)) - 100);
        const float offset = i % 3 == 0 ? 0.0f : scale * std::exp(random.uniform(0, 12));
        std::array<Bounds, compressed_width> boxes;
        Bounds whole;
        for (Bounds& box : boxes) {
            box.extend(Vec3{offset, -offset, offset} + scale * random.point(-1, 1));
            if (i % 5 != 0) // else flat
                box.extend(Vec3{offset, -offset, offset} + scale * random.point(-1, 1));
            whole.extend(box);
        }
        CompressedNode node{};
        quantize(whole, boxes, 0xff, node);
        for (std::uint32_t slot = 0; slot < compressed_width; ++slot) {
            const Bounds decoded = node.bounds(slot);
            ASSERT_TRUE(decoded.contains(boxes[slot])) << i;
            for (int axis = 0; axis < 3; ++axis) {
                const auto step = static_cast<double>(node.step(static_cast<std::uint32_t>(axis)));
                // A step is at most two 255ths of the node, or what rounding near the corners
                // takes.
                const double width =
                    static_cast<double>(whole.upper[axis]) - static_cast<double>(whole.lower[axis]);
                const double ulp = static_cast<double>(max(std::fabs(whole.lower[axis]),
                                                           std::fabs(whole.upper[axis]))) *
                                   0x1p-23;
                ASSERT_LE(step, std::max({2 * width / 255, ulp, 0x1p-126})) << i;
                ASSERT_LE(static_cast<double>(boxes[slot].lower[axis]) -
                              static_cast<double>(decoded.lower[axis]),
                          2 * step + ulp)
                    << i;
            }
        }
    }
}

TEST(CompressNode, RoundsOutwardsWhereADoubleCannotHoldTheDistance) {
    // 1 + 1e-30 and 1 - 1e-30 from the origin of the grid: both are 1 in double, and 0 is a plane.
    const float tiny = 1e-30f;
    std::array<Bounds, compressed_width> boxes;
    boxes[0] = {{-1, -1, -1}, {tiny, tiny, tiny}};
    boxes[1] = {{-tiny, -tiny, -tiny}, {1, 1, 1}};
    CompressedNode node{};
    quantize({{-1, -1, -1}, {1, 1, 1}}, boxes, 3, node);
    EXPECT_TRUE(node.bounds(0).contains(boxes[0]));
    EXPECT_TRUE(node.bounds(1).contains(boxes[1]));
    EXPECT_LE(node.bounds(0).upper.x, 2 * node.step(0));
}

TEST(CompressNode, SlotsHaveTheLeastCostOfAllAssignments) {
    Random random(134);
    for (std::uint32_t count = 1; count <= 6; ++count) {
        std::vector<Bounds> boxes(count);
        for (Bounds& box : boxes)
            box.extend(random.point(-1, 1));
        const auto cost = [&](std::span<const std::uint32_t> slots) {
            double sum = 0;
            for (std::uint32_t i = 0; i < count; ++i)
                for (int axis = 0; axis < 3; ++axis)
                    sum += static_cast<double>(boxes[i].lower[axis]) *
                           ((slots[i] >> axis & 1u) != 0 ? -1 : 1);
            return sum;
        };
        std::array<std::uint32_t, compressed_width> all;
        std::iota(all.begin(), all.end(), 0u);
        double least = std::numeric_limits<double>::infinity();
        do
            least = std::min(least, cost(all));
        while (std::next_permutation(all.begin(), all.end()));
        EXPECT_NEAR(cost(assign_slots(boxes)), least, 1e-6) << count;
    }
}

/// Counts the steps of a traversal.
struct Steps {
    int nodes = 0, primitives = 0;
    void node(std::uint32_t /*index*/) { ++nodes; }
    void primitive(std::uint32_t /*index*/) { ++primitives; }
};

/// The same tree with every slot at the opposite corner: far children come first.
CompressedTree mirrored(CompressedTree tree) {
    for (std::size_t index = 0; index < tree.nodes.size(); ++index) {
        CompressedNode& node = tree.nodes[index];
        const CompressedNode old = node;
        node.exponents &= 0x00ffffffu;
        for (auto* words : {&node.meta, &node.lower[0], &node.lower[1], &node.lower[2],
                            &node.upper[0], &node.upper[1], &node.upper[2]})
            (*words)[0] = (*words)[1] = 0;
        const auto move = [](const std::uint32_t(&from)[2], std::uint32_t slot,
                             std::uint32_t(&to)[2]) {
            const std::uint32_t there = 7 - slot;
            to[there / 4] |= CompressedNode::byte(from, slot) << (8 * (there % 4));
        };
        std::uint32_t below = 0;
        for (std::uint32_t slot = 0; slot < compressed_width; ++slot) {
            move(old.meta, slot, node.meta);
            for (int axis = 0; axis < 3; ++axis) {
                move(old.lower[axis], slot, node.lower[axis]);
                move(old.upper[axis], slot, node.upper[axis]);
            }
            if ((old.inner_mask() >> slot & 1u) == 0)
                continue;
            const std::uint32_t there = 7 - slot;
            ++below;
            node.exponents |= 1u << (24 + there);
            node.meta[there / 4] ^= (slot ^ there) << (8 * (there % 4));
        }
        const auto first = tree.nodes.begin() + static_cast<std::ptrdiff_t>(old.first_child);
        std::reverse(first, first + static_cast<std::ptrdiff_t>(below));
    }
    return tree;
}

TEST(CompressedTraverse, MeetsNearChildrenFirst) {
    const TestGeometry scene(displaced_sphere({0, 0, 0}, 1, 100));
    const CompressedTree tree = build_compressed(scene.view()), far_first = mirrored(tree);
    ASSERT_EQ(check_compressed(far_first.view(), scene.view()), "");
    Random random(135);
    Steps near_steps, far_steps;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 origin = 3.0f * random.direction();
        const Ray ray{origin, 0, random.point(-1, 1) - origin, infinity};
        const Hit hit = closest<TriangleTest::watertight>(tree.view(), ray, near_steps);
        ASSERT_TRUE(
            same_bits(hit, closest<TriangleTest::watertight>(far_first.view(), ray, far_steps)));
    }
    // Far first tests everything along the ray: the far side of the sphere as well.
    EXPECT_LT(1.3 * near_steps.primitives, far_steps.primitives);
    EXPECT_LT(1.2 * near_steps.nodes, far_steps.nodes);
}

TEST(CompressedTraverse, EntersEveryBoxThatTheExactTestEnters) {
    // Rays aimed at corners and edges of boxes near and far: the short test of a plain ray beside
    // slab_interval of the boxes before they were rounded.
    Random random(136);
    int lost = 0, entered = 0, extra = 0;
    for (int i = 0; i < 300000; ++i) {
        const float scale = std::ldexp(1.0f, static_cast<int>(random.index(60)) - 30);
        const Vec3 base = i % 2 == 0 ? Vec3{} : scale * random.point(-1000, 1000);
        std::array<Bounds, compressed_width> boxes;
        Bounds whole;
        // Every other node: boxes on the planes of the grid, which rounding outwards leaves alone.
        const bool on_grid = i % 4 < 2;
        const auto corner_of = [&] {
            if (!on_grid)
                return base + scale * random.point(-1, 1);
            const auto k = [&] { return static_cast<float>(random.index(256)) * 0x1p-7f * scale; };
            const float x = k(), y = k();
            return Vec3{x, y, k()};
        };
        for (Bounds& box : boxes) {
            box.extend(corner_of());
            if (i % 7 != 0)
                box.extend(corner_of());
        }
        if (on_grid)
            boxes[7] = {{0, 0, 0}, scale * 0x1p-7f * Vec3{255, 255, 255}};
        for (const Bounds& box : boxes)
            whole.extend(box);
        CompressedNode node{};
        quantize(whole, boxes, 0xff, node);
        node.meta[0] = 0x23222120; // leaves of one primitive each, at 0 to 7
        node.meta[1] = 0x27262524;
        const Bounds& aim = boxes[random.index(8)];
        const std::uint32_t corner = random.index(8);
        const Vec3 target{(corner & 1u) != 0 ? aim.upper.x : aim.lower.x,
                          (corner & 2u) != 0 ? aim.upper.y : aim.lower.y,
                          (corner & 4u) != 0 ? aim.upper.z : aim.lower.z};
        const float away =
            i % 5 < 2 ? std::ldexp(3.0f, static_cast<int>(random.index(16))) : 3.0f; // tiny boxes
        const Vec3 origin = (on_grid ? Vec3{} : base) + scale * random.point(-away, away);
        Ray ray{origin, 0, target - origin, infinity};
        if (i % 3 == 0)
            ray.direction = std::exp(random.uniform(-20, 20)) * ray.direction;
        if (i % 4 == 0)
            ray.tmax = 1;
        if (!detail::is_plain(ray, 0x1p40f))
            continue;
        const PreparedRay prepared(ray);
        const std::uint32_t one = CompressedView{}.one;
        const std::uint32_t hits = detail::CompressedTest(prepared, true, one)(node, node);
        const std::uint32_t careful = detail::CompressedTest(prepared, false, one)(node, node);
        for (std::uint32_t slot = 0; slot < compressed_width; ++slot) {
            const bool exact =
                overlaps(slab_interval(prepared.slab, boxes[slot]), ray.tmin, ray.tmax);
            const std::uint32_t bit = 1u << slot;
            lost += exact && ((hits & bit) == 0 || (careful & bit) == 0);
            entered += exact;
            extra += !exact && (hits & bit) != 0;
        }
    }
    EXPECT_EQ(lost, 0);
    EXPECT_GT(entered, 300000);
    EXPECT_LT(extra, entered / 4); // not everything
}

} // namespace
} // namespace plumb::test
