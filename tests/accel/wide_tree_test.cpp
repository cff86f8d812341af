/// \file  Invariants of the 8-wide tree, in every quality and for any number of threads.

#include "accel/sah/build_binary.h"
#include "accel/sah/check_wide.h"
#include "accel/sah/collapse.h"
#include "tests/support/hard_scenes.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>

namespace plumb::test {
namespace {

WideBvh build_wide(const GeometryView& view, BuildQuality quality, int threads) {
    return collapse(build_binary(view, {quality, threads}), view, threads);
}

class WideTree : public testing::TestWithParam<BuildQuality> {};
INSTANTIATE_TEST_SUITE_P(Every, WideTree,
                         testing::Values(BuildQuality::fast, BuildQuality::medium,
                                         BuildQuality::high),
                         [](const auto& quality) { return std::string(name_of(quality.param)); });

TEST_P(WideTree, KeepsItsInvariantsOnHardScenes) {
    for (const NamedScene& scene : hard_scenes()) {
        const GeometryView view = scene.geometry.view();
        const WideBvh tree = build_wide(view, GetParam(), 2);
        EXPECT_EQ(check_wide(tree, view, GetParam() == BuildQuality::high), "") << scene.name;
    }
}

TEST_P(WideTree, IsTheSameBytesForAnyNumberOfThreads) {
    for (const NamedScene& scene : hard_scenes()) {
        const GeometryView view = scene.geometry.view();
        const WideBvh one = build_wide(view, GetParam(), 1);
        for (const int threads : {2, 3, 8}) {
            const WideBvh other = build_wide(view, GetParam(), threads);
            ASSERT_EQ(one.memory.bytes(), other.memory.bytes()) << scene.name << ' ' << threads;
            if (one.memory.bytes() == 0)
                continue;
            EXPECT_EQ(std::memcmp(one.memory.data(), other.memory.data(), one.memory.bytes()), 0)
                << scene.name << ' ' << threads;
            EXPECT_EQ(one.sah_cost, other.sah_cost) << scene.name << ' ' << threads;
            EXPECT_EQ(one.depth, other.depth) << scene.name << ' ' << threads;
        }
    }
}

/// The parts of a tree that the damages below are done to.
struct Parts {
    WideBvh& tree;
    WideNode& root;
    WideNode* node = nullptr;        ///< the first inner node below the root
    WideTriangles* block = nullptr;  ///< two triangles or more
    WideTriangles* single = nullptr; ///< lanes that are filled up
    WideSpheres* spheres = nullptr;
};

template <class T> T& at(WideBvh& tree, WideRef ref) {
    return *reinterpret_cast<T*>(tree.memory.data() + ref.unit() * WideView::unit_bytes);
}

void collect(Parts& parts, WideNode& node) {
    for (int i = 0; i < wide_width && !node.bounds(i).empty(); ++i) {
        const WideRef ref = node.child[i];
        if (!ref.is_leaf()) {
            auto& below = at<WideNode>(parts.tree, ref);
            parts.node = parts.node == nullptr ? &below : parts.node;
            collect(parts, below);
        } else if (ref.has_spheres()) {
            parts.spheres = &at<WideSpheres>(parts.tree, ref);
        } else {
            auto& block = at<WideTriangles>(parts.tree, ref);
            if (block.number[1] != block.number[0])
                parts.block = &block;
            if (block.number[7] == block.number[6] && block.number[1] != block.number[0])
                parts.single = &block;
        }
    }
}

Parts parts_of(WideBvh& tree) {
    Parts parts{tree, at<WideNode>(tree, WideRef{})};
    collect(parts, parts.root);
    return parts;
}

struct Damage {
    const char* what;
    std::function<void(Parts&)> apply;
    const char* expected; ///< part of the message
};

std::vector<Damage> damages() {
    return {
        {"a box that is too small",
         [](Parts& p) { p.root.planes[0][1][0] = p.root.planes[0][0][0]; }, "contain"},
        {"half the tree twice", [](Parts& p) { p.root.child[1] = p.root.child[0]; },
         "on something else"},
        {"a reference out of the memory", [](Parts& p) { p.root.child[1].bits = 0x3ffffffe; },
         "outside the memory"},
        {"a child that is lost",
         [](Parts& p) {
             for (int axis = 0; axis < 3; ++axis) {
                 p.node->planes[axis][0][0] = infinity;
                 p.node->planes[axis][1][0] = -infinity;
             }
         },
         "behind one that is not there"},
        {"an inverted box that is not the empty one",
         [](Parts& p) { std::swap(p.node->planes[1][0][0], p.node->planes[1][1][0]); },
         "not there has a box"},
        {"numbers out of order", [](Parts& p) { p.single->number[7] = p.single->number[0]; },
         "ascend"},
        {"another triangle's vertices", [](Parts& p) { p.block->vertex[1][2][0] += 1e-3f; },
         "differs"},
        {"a filled-up lane of its own", [](Parts& p) { p.single->vertex[0][0][7] += 1e-3f; },
         "differs"},
        {"a number that does not exist", [](Parts& p) { p.block->number[7] = 0x7fffffff; },
         "does not exist"},
        {"a sphere of another size", [](Parts& p) { p.spheres->sphere[0].radius *= 2; }, "differs"},
        {"a depth counted wrongly", [](Parts& p) { ++p.tree.depth; }, "counted"},
        {"lanes counted wrongly", [](Parts& p) { ++p.tree.lane_count; }, "counted"},
        {"a first number that is wrong", [](Parts& p) { ++p.tree.first_of[1]; }, "first_of"},
        {"no padding", [](Parts& p) { --p.tree.first_of.back(); }, "padded"},
        {"a reach that is too small", [](Parts& p) { p.tree.reach *= 0.5f; }, "reach"},
    };
}

TEST(WideTreeCheck, SeesADamagedTree) {
    const TestGeometry scene = mixed_scene(126);
    for (const Damage& damage : damages()) {
        WideBvh tree = build_wide(scene.view(), BuildQuality::medium, 1);
        ASSERT_EQ(check_wide(tree, scene.view(), false), "");
        Parts parts = parts_of(tree);
        ASSERT_TRUE(parts.node != nullptr && parts.block != nullptr && parts.single != nullptr &&
                    parts.spheres != nullptr);
        damage.apply(parts);
        EXPECT_NE(check_wide(tree, scene.view(), false).find(damage.expected), std::string::npos)
            << damage.what << ": " << check_wide(tree, scene.view(), false);
    }
}

TEST(WideTreeCheck, TellsTreesOfOneLevel) {
    const auto one_level = [](const TestGeometry& scene) {
        return build_wide(scene.view(), BuildQuality::medium, 1).view().one_level;
    };
    Random random(128);
    TestGeometry room(box({-1, -1, -1}, {1, 1, 1}));
    EXPECT_TRUE(one_level(room));
    room.add(box({-0.5f, -1, -0.5f}, {0, 0, 0}));
    EXPECT_TRUE(one_level(room));
    room.add(Sphere{{0.5f, 0, 0}, 0.1f});
    EXPECT_FALSE(one_level(room));
    EXPECT_FALSE(one_level(TestGeometry(triangle_soup(random, 65, 0.3f))));
    EXPECT_FALSE(one_level(TestGeometry()));
}

TEST(WideTreeCheck, TellsSplitTrianglesFromLostOnes) {
    Mesh mesh = displaced_sphere({0, 0, 0}, 3, 24);
    Random random(127);
    for (int i = 0; i < 40; ++i)
        mesh.add_triangle(random.point(-20, 20), random.point(-20, 20), random.point(-20, 20));
    const TestGeometry scene(std::move(mesh));
    const WideBvh split = build_wide(scene.view(), BuildQuality::high, 1);
    ASSERT_GT(split.lane_count, scene.view().primitive_count()) << "nothing was split";
    EXPECT_EQ(check_wide(split, scene.view(), true), "");
    EXPECT_NE(check_wide(split, scene.view(), false), "");
}

TEST(WideTreeCheck, HoldsMeshesAroundEmptyOnes) {
    TestGeometry scene;
    scene.add(Mesh{});
    scene.add(repeated_triangle(3));
    scene.add(Mesh{});
    scene.add(Mesh{{{0, 0, 0}}, {}});
    scene.add(repeated_triangle(20));
    scene.add(Mesh{});
    for (const BuildQuality quality : {BuildQuality::fast, BuildQuality::high})
        EXPECT_EQ(check_wide(build_wide(scene.view(), quality, 2), scene.view(),
                             quality == BuildQuality::high),
                  "");
}

} // namespace
} // namespace plumb::test
