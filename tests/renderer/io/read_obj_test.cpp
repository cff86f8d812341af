/// \file  OBJ files: what they mean, and one row for each refusal and warning.
#include "renderer/io/read_obj.h"
#include "renderer/scene/error.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <unistd.h>

namespace plumb {
namespace {

/// ctest runs the tests as processes side by side.
const std::string name = "read_obj_" + std::to_string(::getpid()) + ".obj";
const std::string file = testing::TempDir() + name;
const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

struct Reading {
    Mesh mesh;
    std::vector<std::string> warnings;
    std::string error; ///< without `FILE:`
};

Reading read(const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    Reading reading;
    try {
        reading.mesh = read_obj(file, reading.warnings);
    } catch (const SceneError& error) {
        EXPECT_EQ(error.exit_code(), 4);
        EXPECT_EQ(std::string(error.what()).find(file + ":"), 0u) << error.what();
        reading.error = std::string(error.what()).substr(file.size() + 1);
    }
    ::unlink(file.c_str());
    return reading;
}

/// Positions of the corners of triangle i.
std::vector<Vec3> corners(const Mesh& mesh, std::size_t i) {
    const Triangle t = mesh.triangles[i];
    return {mesh.positions[t.a], mesh.positions[t.b], mesh.positions[t.c]};
}

TEST(ReadObj, ReadsTheSameTriangleFromEveryWriting) {
    const std::vector<Vec3> expected = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::string rows[] = {
        three + "f 1 2 3\n",
        three + "f 1 2 3", // no final newline
        "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
        "\tv\t0 0\t0 \nv   1.0 +0 0.\nv .0 10e-1 -0\n\n  f\t1  2 3  \n",
        three + "f -3 -2 -1\n",
        "f 1 2 3\n" + three, // forwards
        three + "f 1 2 \\\n3\n",
        three + "f 1 \\\r\n2 \\\r\n3\r\n",
        "# comment \\\n" + three + "f 1 2 3 # comment\n",
        "\xef\xbb\xbf" + three + "f 1 2 3\n",
        "v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 1 0.5 0.5 0.5 1\nf 1 2 3\n",
        "mtllib a b.mtl\no x\n" + three + "g y\\\nusemtl z\ns off\nl 1 2\np 1\nf 1 2 3\n",
        three + "f 1/ 2/ 3/\n",
        three + "f 1// 2// 3//\n",
        three + "v 9 9 9\nf 1 2 3\n", // an unused vertex
        three + "v 1e-999 0 0\nf 1 2 3\n",
    };
    for (const std::string& text : rows) {
        const Reading reading = read(text);
        EXPECT_EQ(reading.error, "") << text;
        EXPECT_TRUE(reading.warnings.empty()) << text << reading.warnings[0];
        ASSERT_EQ(reading.mesh.triangles.size(), 1u) << text;
        EXPECT_EQ(corners(reading.mesh, 0), expected) << text;
        EXPECT_TRUE(reading.mesh.normals.empty());
        EXPECT_TRUE(reading.mesh.uvs.empty());
    }
    EXPECT_EQ(read(rows[0]).mesh.name, name);
}

TEST(ReadObj, RefusesBadInputAtItsLineAndColumn) {
    const std::string normal = "vn 0 0 1\n", uv = "vt 0 0\n";
    const struct {
        std::string text, error;
    } rows[] = {
        {three + "f 0 1 2\n",
         "4:3: error: invalid vertex index (got '0', expected 1 to 3 or -3 to -1)"},
        {three + "f 1 2 4\n", "4:7: error: invalid vertex index (got '4', expected 1 to 3"},
        {three + "f 1 2 9\nf 1 2 4\nf 1 2 9\n", "4:7: error: invalid vertex index (got '9'"},
        {three + "f -1 -2 -4\n", "4:9: error: invalid vertex index (got '-4'"},
        {"v 0 0 0\nv 1 0 0\nf -1 -2 -3\nv 0 1 0\n",
         "3:9: error: invalid vertex index (got '-3', expected 1 to 2"},
        {"f -1 -2 -3\n" + three, "1:3: error: invalid vertex index (got '-1', expected none"},
        {three + "f 4294967297 2 3\n", "4:3: error: invalid vertex index (got '4294967297'"},
        {three + "f 4294967295 2 3\n", "4:3: error: invalid vertex index (got '4294967295'"},
        {three + "f -4294967295 2 3\n", "4:3: error: invalid vertex index (got '-4294967295'"},
        {three + "f 1 2 99999999999999999999\n",
         "4:7: error: invalid vertex index (got '99999999999999999999'"},
        {three + "f 1 2 3.0\n", "4:7: error: invalid corner of a face (got '3.0'"},
        {three + "f 1 2 x\n", "4:7: error: invalid vertex index (got 'x'"},
        {three + "f 1 2 3/x\n", "4:9: error: invalid texture coordinate index (got 'x'"},
        {three + "f 1/1 2/1 3/1\n", "4:5: error: invalid texture coordinate index (got '1'"},
        {three + uv + "f 1/1 2/1 3/2\n",
         "5:13: error: invalid texture coordinate index (got '2', expected 1 to 1"},
        {three + uv + "f 1/1 2/1 3/0\n", "5:13: error: invalid texture coordinate index (got '0'"},
        {three + normal + "f 1//1 2//1 3//2\n", "5:16: error: invalid normal index (got '2'"},
        {three + normal + "f 1//1 2//1 3//-2\n", "5:16: error: invalid normal index (got '-2'"},
        {three + normal + "f 1//1 2//1 3//1/1\n",
         "5:13: error: invalid corner of a face (got '3//1/1'"},
        {three + "f\n", "4:1: error: face has too few corners (got '0', expected at least 3)"},
        {three + "f 1\n", "4:1: error: face has too few corners (got '1'"},
        {three + "  f 1 2 # 3\n", "4:3: error: face has too few corners (got '2'"},
        {"v 1 2\n", "1:6: error: number is missing (got the end of the line)"},
        {"v 0 0 0\nv\n", "2:2: error: number is missing"},
        {"v 1 2 # 3\n", "1:7: error: number is missing"},
        {"v 1 2 nan\n", "1:7: error: invalid number (got 'nan', expected a decimal number)"},
        {"v inf 2 3\n", "1:3: error: invalid number (got 'inf'"},
        {"v 1,5 2 3\n", "1:3: error: invalid number (got '1,5'"},
        {"v 1 12abc 3\n", "1:5: error: invalid number (got '12abc'"},
        {"v 1 2 1e999\n", "1:7: error: invalid number (got '1e999'"},
        {"v 1 2 1e39\n", "1:7: error: invalid number (got '1e39'"},
        {"v 1 2 1.9e18\n",
         "1:7: error: number is too large (got '1.9e18', expected at most 1.8e18)"},
        {"v 1 2 3 x\n", "1:9: error: invalid number (got 'x'"},
        {"v 1 2 3 4 5 6 7 8 9\n", "1:19: error: superfluous value (got '9'"},
        {"v 0 0 0\rv 1 0 0\rf 1 1 1\r", "1:9: error: invalid number (got 'v'"}, // lone CRs
        {"vn 0 0\n", "1:7: error: number is missing"},
        {"vn 0 0 nan\n", "1:8: error: invalid number (got 'nan'"},
        {"vn 0 0 1 0\n", "1:10: error: superfluous value (got '0', expected x y z)"},
        {"vt\n", "1:3: error: number is missing"},
        {"vt 0 0 0 0\n", "1:10: error: superfluous value (got '0', expected u v w)"},
        {three + "f 1 \\\n2 \\\n4\n", "6:1: error: invalid vertex index (got '4'"}, // physical line
        {"v 0 0 \xff\x01\n", "1:7: error: invalid number (got '\?\?'"},
        {std::string("v 0 0 0\0\n", 9), "1:7: error: invalid number (got '0?'"},
    };
    for (const auto& row : rows)
        EXPECT_EQ(read(row.text).error.find(row.error), 0u)
            << row.text << "expected " << row.error << "\ngot      " << read(row.text).error;
}

TEST(ReadObj, WarnsWithTheCountOfWhatItDrops) {
    const struct {
        std::string text, warning;
        std::size_t triangles;
    } rows[] = {
        {"", "the mesh has no triangles", 0},
        {three, "the mesh has no triangles", 0},
        {three + "f 1 1 2\nf 1 2 3\n", "1 of 2 triangles have no area and are dropped", 1},
        {three + "v 2 0 0\nf 1 2 4\nf 1 2 3 3\n", "2 of 3 triangles have no area", 1},
        {three + "f 1 1 1\nf 2 2 3\n", "2 of 2 triangles have no area", 0},
        {three + "vx 1\nf 1 2 3\nfoo\n",
         "2 unknown statements are ignored (the first: 'vx' in line 4)", 1},
        {three + "vn 0 0 1\nf 1//1 2//1 3//1\nf 1//1 2//1 3\n",
         "1 of 6 corners of faces have no normal: all normals are ignored", 2},
        {three + "vt 0 1\nf 1/1 2/1 3\n",
         "1 of 3 corners of faces have no texture coordinate: they get (0,0)", 1},
        {three + "vn 0 0 0\nf 1//1 2//1 3//1\n", "3 vertex normals are zero and are replaced", 1},
        {three + "vn 0 0 1\nf 1//1 3//1 2//1\n",
         "1 triangles are wound against their vertex normals", 1},
    };
    for (const auto& row : rows) {
        const Reading reading = read(row.text);
        EXPECT_EQ(reading.error, "") << row.text;
        ASSERT_FALSE(reading.warnings.empty()) << row.text;
        EXPECT_EQ(reading.warnings[0].find(file + ": warning: " + row.warning), 0u)
            << row.text << reading.warnings[0];
        EXPECT_EQ(reading.mesh.triangles.size(), row.triangles) << row.text;
    }
}

TEST(ReadObj, SharesVerticesOfEqualTriplesOnly) {
    const std::string values = three + "v 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvn 0 0 2\n";
    const Reading direct =
        read(values + "vn 0 0 1\nvn 0 0 1\nvn 0 0 1\nf 1/1/1 2/2/2 3/3/3\nf 2/2/2 4/4/4 3/3/3\n");
    EXPECT_EQ(direct.mesh.positions.size(), 4u);
    EXPECT_EQ(direct.mesh.uvs[3].y, 1);
    EXPECT_EQ(direct.mesh.normals[0], (Vec3{0, 0, 1})); // made a unit vector
    // The second face leaves the direct numbering: the first must follow.
    const Reading mixed = read(values + "f 1/1 2/2 3/3\nf 2/2 4/3 3/3\n");
    EXPECT_EQ(mixed.error, "");
    ASSERT_EQ(mixed.mesh.triangles.size(), 2u);
    EXPECT_EQ(mixed.mesh.positions.size(), 4u); // 2/2 and 3/3 are shared
    EXPECT_EQ(corners(mixed.mesh, 0), (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(corners(mixed.mesh, 1), (std::vector<Vec3>{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(mixed.mesh.uvs[mixed.mesh.triangles[1].b].y, 1);
    EXPECT_EQ(mixed.mesh.uvs[mixed.mesh.triangles[1].b].x, 0);
    // One position with many uvs: as many vertices as different pairs.
    std::string seam = three, faces;
    for (int i = 1; i <= 300; ++i) {
        seam += "vt " + std::to_string(i) + " 0\n";
        faces += "f 1/" + std::to_string(i) + " 2/1 3/1\n";
    }
    const Reading split = read(seam + faces + faces);
    EXPECT_EQ(split.mesh.positions.size(), 302u);
    ASSERT_EQ(split.mesh.triangles.size(), 600u);
    for (std::size_t i = 0; i < 600; ++i)
        EXPECT_EQ(split.mesh.uvs[split.mesh.triangles[i].a].x, static_cast<float>(i % 300 + 1));
}

TEST(ReadObj, SplitsPolygonsIntoFans) {
    const Reading reading = read("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n");
    ASSERT_EQ(reading.mesh.triangles.size(), 3u);
    EXPECT_EQ(corners(reading.mesh, 2), (std::vector<Vec3>{{0, 0, 0}, {2, 2, 0}, {0, 2, 0}}));
}

TEST(ReadObj, TurnsTrianglesToTheSideOfTheirNormals) {
    const Reading reading = read(three + "vn 0 0 -1\nf 1//1 2//1 3//1\n");
    const std::vector<Vec3> t = corners(reading.mesh, 0);
    EXPECT_LT(cross(t[1] - t[0], t[2] - t[0]).z, 0);
}

TEST(ReadObj, ReadsAFaceOfAMillionCorners) {
    std::string text, face = "f";
    for (int i = 0; i < 1000000; ++i) {
        text += "v " + std::to_string(i) + " " + std::to_string(i % 1000 * (i % 1000)) + " 0\n";
        face.append(1, ' ').append(std::to_string(i + 1));
    }
    const Reading reading = read(text + face + "\n");
    EXPECT_EQ(reading.error, "");
    EXPECT_GT(reading.mesh.triangles.size(), 990000u);
}

TEST(ReadObj, RefusesALineOfAGigabyteAtOnce) {
    std::ofstream(file, std::ios::binary) << three << "v 1 ";
    ASSERT_EQ(::truncate(file.c_str(), off_t{1} << 30), 0); // sparse: takes no space
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::string> warnings;
    try {
        static_cast<void>(read_obj(file, warnings));
        FAIL() << "was read";
    } catch (const SceneError& error) {
        EXPECT_EQ(error.what(), file + ":4:1: error: line is too long (expected at most 32 MiB)");
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    EXPECT_LT(elapsed.count(), 1.0);
    ::unlink(file.c_str());
}

TEST(ReadObj, RefusesFilesThatCannotBeRead) {
    std::vector<std::string> warnings;
    for (const std::string& bad : {testing::TempDir() + "no_such.obj", testing::TempDir()}) {
        try {
            static_cast<void>(read_obj(bad, warnings));
            FAIL() << bad;
        } catch (const SceneError& error) {
            EXPECT_EQ(error.exit_code(), 4);
            EXPECT_EQ(std::string(error.what()).find(bad + ": error: "), 0u) << error.what();
        }
    }
}

} // namespace
} // namespace plumb
