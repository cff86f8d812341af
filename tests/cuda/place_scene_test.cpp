/// \file  What is placed on a device is a whole copy: nothing points back to the host's scene.

#include "cuda/host_executor.h"

#include "accel/sah/build_compressed.h"
#include "accel/sah/build_sah.h"

#include <gtest/gtest.h>

namespace plumb::test {
namespace {

/// Two meshes (one with normals), two spheres, two surfaces a kind, one light.
class PlaceScene : public ::testing::Test {
  protected:
    PlaceScene() {
        view.geometry = {meshes, spheres};
        view.normals = mesh_normals;
        view.surfaces = surfaces;
        view.surface_lights = surface_lights;
        view.materials = materials;
        view.lights = lights;
        view.light_cdf = cdf;
    }

    std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::vector<Vec3> normals{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}};
    std::vector<Triangle> triangles{{0, 1, 2}, {1, 2, 3}};
    std::vector<MeshView> meshes{{positions, triangles}, {positions, {&triangles[1], 1}}};
    std::vector<std::span<const Vec3>> mesh_normals{{}, normals};
    std::vector<Sphere> spheres{{{1, 2, 3}, 4}, {{5, 6, 7}, 8}};
    std::vector<Surface> surfaces{4};
    std::vector<SurfaceLights> surface_lights{4};
    std::vector<Material> materials{2};
    std::vector<Light> lights{1};
    std::vector<float> cdf{0, 1};
    SceneView view;
};

TEST_F(PlaceScene, MeasuringPredictsTheBytes) {
    Arena measure;
    static_cast<void>(place(view, measure));
    HostBlock block(measure.used());
    Arena arena = block.arena();
    static_cast<void>(place(view, arena));
    EXPECT_EQ(arena.used(), measure.used());
    EXPECT_GT(arena.used(), positions.size() * sizeof(Vec3));
}

TEST_F(PlaceScene, EveryArrayLiesInTheBlock) {
    Arena measure;
    static_cast<void>(place(view, measure));
    HostBlock block(measure.used());
    Arena arena = block.arena();
    const SceneView copy = place(view, arena);
    EXPECT_TRUE(block.holds(copy.geometry.meshes));
    EXPECT_TRUE(block.holds(copy.geometry.spheres));
    EXPECT_TRUE(block.holds(copy.normals));
    EXPECT_TRUE(block.holds(copy.surfaces));
    EXPECT_TRUE(block.holds(copy.surface_lights));
    EXPECT_TRUE(block.holds(copy.materials));
    EXPECT_TRUE(block.holds(copy.lights));
    EXPECT_TRUE(block.holds(copy.light_cdf));
    for (const MeshView& mesh : copy.geometry.meshes) {
        EXPECT_TRUE(block.holds(mesh.positions));
        EXPECT_TRUE(block.holds(mesh.triangles));
    }
    for (const std::span<const Vec3>& mesh : copy.normals)
        EXPECT_TRUE(block.holds(mesh));
}

TEST_F(PlaceScene, TheCopyHoldsWhatTheSceneHolds) {
    Arena measure;
    static_cast<void>(place(view, measure));
    HostBlock block(measure.used());
    Arena arena = block.arena();
    const SceneView copy = place(view, arena);
    ASSERT_EQ(copy.geometry.meshes.size(), 2u);
    EXPECT_EQ(copy.geometry.meshes[0].positions[3], positions[3]);
    EXPECT_EQ(copy.geometry.meshes[1].triangles[0].c, 3u);
    EXPECT_TRUE(copy.normals[0].empty());
    EXPECT_EQ(copy.normals[1][1], normals[1]);
    EXPECT_EQ(copy.geometry.spheres[1].radius, 8);
    EXPECT_EQ(copy.surfaces.size(), 4u);
    EXPECT_EQ(copy.light_cdf[1], 1);
}

TEST_F(PlaceScene, AJobsFilterLiesInTheBlockToo) {
    RenderJob job;
    job.scene = view;
    job.filter.kind = FilterKind::gaussian;
    job.filter.cdf[100] = 0.25f;
    HostBlock block(placed_size(job, {}));
    Arena arena = block.arena();
    const DeviceJob device = place(job, {}, arena);
    ASSERT_TRUE(block.holds(device.filter, sizeof(FilterTable)));
    EXPECT_EQ(device.filter->kind, FilterKind::gaussian);
    EXPECT_EQ(device.filter->cdf[100], 0.25f);
    EXPECT_TRUE(block.holds(device.job.scene.lights));
}

TEST(PlaceTree, ATreeIsCopiedWhole) {
    const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<Triangle> triangles(20, Triangle{0, 1, 2});
    const std::vector<MeshView> meshes{{positions, triangles}};
    const std::vector<Sphere> spheres{{{3, 0, 0}, 1}};
    const SahTree built = build_sah({meshes, spheres});
    const SahView tree = built.view();
    Arena measure;
    static_cast<void>(place(tree, measure));
    HostBlock block(measure.used());
    Arena arena = block.arena();
    const SahView copy = place(tree, arena);
    EXPECT_TRUE(block.holds(copy.nodes, copy.node_count * sizeof(SahNode)));
    EXPECT_TRUE(block.holds(copy.blocks, copy.block_count * sizeof(TriangleBlock)));
    EXPECT_TRUE(block.holds(copy.spheres, copy.sphere_count * sizeof(SahSphere)));
    EXPECT_EQ(std::memcmp(copy.nodes, tree.nodes, tree.node_count * sizeof(SahNode)), 0);
    EXPECT_EQ(std::memcmp(copy.blocks, tree.blocks, tree.block_count * sizeof(TriangleBlock)), 0);
    EXPECT_EQ(copy.spheres[0].sphere.center, spheres[0].center);
    EXPECT_EQ(copy.sphere_geometry, 1u);
}

TEST(PlaceTree, ACompressedTreeIsCopiedWhole) {
    const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<Triangle> triangles(40, Triangle{0, 1, 2});
    const std::vector<MeshView> meshes{{positions, triangles}};
    const CompressedTree built = build_compressed({meshes, {}});
    TreeViews trees;
    trees.wide = built.view();
    HostBlock block(placed_size({}, trees));
    Arena arena = block.arena();
    const CompressedView copy = place(trees, arena).wide;
    const std::size_t nodes = copy.node_count * sizeof(CompressedNode);
    const std::size_t primitives = copy.primitive_count * sizeof(CompressedPrimitive);
    EXPECT_TRUE(block.holds(copy.nodes, nodes));
    EXPECT_TRUE(block.holds(copy.primitives, primitives));
    EXPECT_EQ(std::memcmp(copy.nodes, built.nodes.data(), nodes), 0);
    EXPECT_EQ(std::memcmp(copy.primitives, built.primitives.data(), primitives), 0);
    EXPECT_EQ(copy.primitive_count, 40u);
    EXPECT_EQ(copy.reach, built.reach);
}

} // namespace
} // namespace plumb::test
