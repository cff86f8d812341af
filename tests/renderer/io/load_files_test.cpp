/// \file  Files that scenes name: includes, search paths, meshes in any letter case.

#include "tests/renderer/io/load_scene_files.h"

#include <algorithm>
#include <cmath>

namespace plumb::test {
namespace {

constexpr std::string_view one_triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

class LoadFiles : public SceneFiles {
  protected:
    [[nodiscard]] Scene obj(const std::string& name, const std::string& properties = {}) const {
        return load(in_scene("<shape type='obj'><string name='filename' value='" + name + "'/>" +
                             properties + "</shape>"));
    }
};

TEST_F(LoadFiles, MeshNamesMayDifferInCaseAndUseBackslashes) {
    write("Meshes/Big Tri.OBJ", one_triangle);
    for (const char* name : {"Meshes/Big Tri.OBJ", "meshes/big tri.obj", "MESHES\\BIG TRI.obj",
                             ".\\meshes\\..\\meshes\\Big Tri.obj"}) {
        const Scene scene = obj(name);
        ASSERT_EQ(scene.meshes.size(), 1u);
        EXPECT_EQ(scene.meshes[0].triangles.size(), 1u) << name;
    }
    const std::string absolute = (folder() / "meshes" / "BIG tri.obj").string();
    EXPECT_EQ(obj(absolute).meshes[0].triangles.size(), 1u);
}

TEST_F(LoadFiles, TheExactNameWinsOverAnotherCase) {
    write("A.obj", one_triangle);
    write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
    EXPECT_EQ(obj("a.obj").meshes[0].triangles.size(), 2u);
    EXPECT_EQ(obj("A.obj").meshes[0].triangles.size(), 1u);
}

TEST_F(LoadFiles, PathsAreSearchedAfterTheScenesFolderTheLastFirst) {
    write("one/a.obj", one_triangle);
    write("two/a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
    const auto text = [](const char* paths) {
        return in_scene(std::string(paths) +
                        "<shape type='obj'><string name='filename' value='a.obj'/></shape>");
    };
    EXPECT_EQ(load(text("<path value='one'/>")).meshes[0].triangles.size(), 1u);
    EXPECT_EQ(load(text("<path value='one'/><path value='two'/>")).meshes[0].triangles.size(), 2u);
    write("a.obj", one_triangle);
    EXPECT_EQ(load(text("<path value='two'/>")).meshes[0].triangles.size(), 1u);
    const Scene scene = load(text("<path value='three'/>"));
    EXPECT_TRUE(std::any_of(scene.warnings.begin(), scene.warnings.end(), [](const auto& w) {
        return w.find("warning: <path> 'three' not found") != std::string::npos;
    }));
}

TEST_F(LoadFiles, IncludedScenesAreSplicedInWithTheirOwnFolder) {
    write("parts/tri.obj", one_triangle);
    write("parts/geometry.xml", R"(<scene version="0.6.0">
<default name="size" value="5"/>
<shape type="obj" id="tri"><string name="filename" value="tri.obj"/><ref id="m"/></shape>
<include filename="ball.xml"/></scene>)");
    write("parts/ball.xml", "<shape type='sphere'><float name='radius' value='$size'/></shape>");
    const Scene scene = load(in_scene(R"(<default name="where" value="parts"/>
<include filename="$where/geometry.xml"/>
<bsdf type="diffuse" id="m"><rgb name="reflectance" value="0.3"/></bsdf>)"));
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].name, "tri");
    EXPECT_EQ(scene.materials[scene.surfaces[0].front].reflectance.r, 0.3f);
    ASSERT_EQ(scene.spheres.size(), 1u);
    EXPECT_EQ(scene.spheres[0].radius, 5);
    // Twice the same file is no cycle.
    const Scene twice = load(in_scene("<default name='size' value='1'/>"
                                      "<include filename='parts/ball.xml'/>"
                                      "<include filename='parts/ball.xml'/>"));
    EXPECT_EQ(twice.spheres.size(), 2u);
}

TEST_F(LoadFiles, IncludesMayStandInsideAnObject) {
    write("material.xml", "<bsdf type='diffuse'><rgb name='reflectance' value='0.7'/></bsdf>");
    const Scene scene = load(in_scene("<shape type='cube'><include filename='material.xml'/>"
                                      "</shape>"));
    EXPECT_EQ(scene.materials.at(0).reflectance.r, 0.7f);
}

TEST_F(LoadFiles, MeshesWithoutNormalsAreSmoothUnlessFaceNormalsAreAsked) {
    // Two triangles that meet at a right angle along (0,0,0)-(0,1,0).
    write("fold.obj", "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\n");
    const Scene smooth = obj("fold.obj");
    ASSERT_EQ(smooth.meshes[0].normals.size(), smooth.meshes[0].positions.size());
    const Vec3 n = smooth.meshes[0].normals[0]; // both angles at the first vertex are 90 degrees
    EXPECT_NEAR(n.x, std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(n.z, std::sqrt(0.5), 1e-6);
    const Scene flat = obj("fold.obj", "<boolean name='faceNormals' value='true'/>");
    EXPECT_TRUE(flat.meshes[0].normals.empty());
}

TEST_F(LoadFiles, FlippedMeshesTurnTheirTriangles) {
    write("tri.obj", one_triangle);
    const auto normal_z = [](const Scene& scene) {
        const Mesh& m = scene.meshes[0];
        const Triangle t = m.triangles[0];
        const Vec3 a = m.positions[t.a], b = m.positions[t.b], c = m.positions[t.c];
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    EXPECT_GT(normal_z(obj("tri.obj")), 0);
    EXPECT_LT(normal_z(obj("tri.obj", "<boolean name='flip_normals' value='true'/>")), 0);
}

TEST_F(LoadFiles, PropertiesThatWouldChangePixelsAreRefusedByName) {
    write("tri.obj", one_triangle);
    const std::string message =
        error(in_scene("<shape type='obj'><string name='filename' value='tri.obj'/>\n"
                       "<float name='maxSmoothAngle' value='30'/></shape>"));
    EXPECT_EQ(message, "scene.xml:3:1: error: property 'max_smooth_angle' of shape 'obj' is not "
                       "supported yet");
}

} // namespace
} // namespace plumb::test
