/// \file  PLY files: what they mean, and one row for each refusal and warning.
#include "renderer/io/read_ply.h"
#include "renderer/scene/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <unistd.h>

namespace plumb {
namespace {

/// ctest runs the tests as processes side by side.
const std::string name = "read_ply_" + std::to_string(::getpid()) + ".ply";
const std::string file = testing::TempDir() + name;

struct Reading {
    Mesh mesh;
    std::vector<std::string> warnings;
    std::string error; ///< without `FILE:`
    double seconds = 0;
};

Reading read(const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    Reading reading;
    const auto start = std::chrono::steady_clock::now();
    try {
        reading.mesh = read_ply(file, reading.warnings);
    } catch (const SceneError& error) {
        EXPECT_EQ(error.exit_code(), 4);
        EXPECT_EQ(std::string(error.what()).find(file + ":"), 0u) << error.what();
        reading.error = std::string(error.what()).substr(file.size() + 1);
    }
    reading.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ::unlink(file.c_str());
    return reading;
}

/// Packs values for a binary body.
class Bytes {
  public:
    explicit Bytes(bool big_endian)
        : swap_(big_endian == (std::endian::native == std::endian::little)) {}
    template <class Value> Bytes& add(Value value) {
        char bytes[sizeof(Value)];
        std::memcpy(bytes, &value, sizeof(Value));
        if (swap_)
            std::reverse(std::begin(bytes), std::end(bytes));
        text_.append(bytes, sizeof(Value));
        return *this;
    }
    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    bool swap_;
    std::string text_;
};

std::string header(const std::string& format, const std::string& lines) {
    return "ply\nformat " + format + " 1.0\n" + lines + "end_header\n";
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string vertices = "element vertex 3\n" + xyz;
const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string points = "0 0 0\n1 0 0\n0 1 0\n";

void expect_triangle(const Reading& reading, const std::string& what) {
    EXPECT_EQ(reading.error, "") << what;
    EXPECT_TRUE(reading.warnings.empty()) << what << ": " << reading.warnings[0];
    ASSERT_EQ(reading.mesh.triangles.size(), 1u) << what;
    const Triangle t = reading.mesh.triangles[0];
    EXPECT_EQ(reading.mesh.positions[t.a], (Vec3{0, 0, 0})) << what;
    EXPECT_EQ(reading.mesh.positions[t.b], (Vec3{1, 0, 0})) << what;
    EXPECT_EQ(reading.mesh.positions[t.c], (Vec3{0, 1, 0})) << what;
}

TEST(ReadPly, ReadsTheSameTriangleFromEveryAsciiWriting) {
    const std::string plain = header("ascii", vertices + face) + points + "3 0 1 2\n";
    std::string crlf;
    for (const char c : plain)
        crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
    const std::string rows[] = {
        plain,
        crlf,
        plain.substr(0, plain.size() - 1), // no final newline
        header("ascii", "comment x\nobj_info y\n" + vertices + face) + "\n" + points +
            "\n 3\t0 1 2 \n\n",
        header("ascii", face + vertices) + "3 0 1 2\n" + points, // faces first
        header("ascii", "element vertex 3\nproperty double z\nproperty uchar red\nproperty int x\n"
                        "property list uchar float w\nproperty float32 y\n" +
                            face) +
            "0 255 0 0 0\n0 0 1 2 7 8 0\n0 1 0 1 9 1\n3 0 1 2\n",
        header("ascii", "element extra 2\nproperty list int int a\nproperty float b\n" + vertices +
                            face + "property uchar flag\nproperty list uchar float texcoord\n") +
            "2 7 8 0\n0 x\n" + points + "3 0 1 2 1 6 0 0 0 0 0 0\n",
        header("ascii", vertices + "element face 1\nproperty list uint8 uint16 vertex_index\n") +
            points + "3 0 1 2\n",
        header("ascii", vertices + "element none 999999999999\n" + face) + points + "3 0 1 2\n",
    };
    for (const std::string& text : rows)
        expect_triangle(read(text), text);
    EXPECT_EQ(read(plain).mesh.name, name);
}

TEST(ReadPly, ReadsBothByteOrdersAndAllTypes) {
    for (const bool big : {false, true}) {
        const std::string format = big ? "binary_big_endian" : "binary_little_endian";
        Bytes body(big);
        const double corners[3][2] = {{0, 0}, {1, 0}, {0, 1}};
        for (const auto& c : corners)
            body.add<std::uint16_t>(7)
                .add<double>(c[0])
                .add<std::int8_t>(static_cast<std::int8_t>(c[1]))
                .add<std::uint8_t>(1)
                .add<std::int16_t>(-2)
                .add<float>(0);
        body.add<std::int32_t>(3).add<std::int16_t>(0).add<std::int16_t>(1).add<std::int16_t>(2);
        const std::string lines =
            "element vertex 3\nproperty ushort a\nproperty double x\nproperty char y\n"
            "property list uchar short b\nproperty float z\n"
            "element face 1\nproperty list int short vertex_index\n";
        expect_triangle(read(header(format, lines) + body.text()), format);
        // A CRLF header before the same body, whose first byte is a newline.
        std::string crlf;
        for (const char c : header(format, lines))
            crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
        std::string newline_first = body.text();
        newline_first[0] = '\n';
        expect_triangle(read(crlf + newline_first), "CRLF " + format);
    }
}

TEST(ReadPly, ReadsNormalsAndEveryNameOfTextureCoordinates) {
    const std::string names[][2] = {
        {"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}};
    for (const auto& pair : names) {
        const Reading reading =
            read(header("ascii", vertices +
                                     "property float nx\nproperty float ny\nproperty float nz\n"
                                     "property float " +
                                     pair[0] + "\nproperty float " + pair[1] + "\n" + face) +
                 "0 0 0 0 0 2 0 0\n1 0 0 0 0 2 1 0\n0 1 0 0 0 2 0.5 1\n3 0 1 2\n");
        expect_triangle(reading, pair[0]);
        EXPECT_EQ(reading.mesh.normals[1], (Vec3{0, 0, 1}));
        ASSERT_EQ(reading.mesh.uvs.size(), 3u);
        EXPECT_EQ(reading.mesh.uvs[2].x, 0.5f);
        EXPECT_EQ(reading.mesh.uvs[2].y, 1);
    }
    // Two of three normal components are no normal.
    const Reading partial =
        read(header("ascii",
                    vertices + "property float nx\nproperty float ny\nproperty float u\n" + face) +
             "0 0 0 0 0 0\n1 0 0 0 0 0\n0 1 0 0 0 0\n3 0 1 2\n");
    expect_triangle(partial, "partial");
    EXPECT_TRUE(partial.mesh.normals.empty());
    EXPECT_TRUE(partial.mesh.uvs.empty());
}

TEST(ReadPly, SplitsPolygonsIntoFans) {
    std::string lines =
        "element vertex 255\n" + xyz + "element face 1\nproperty list uchar uchar vertex_indices\n";
    Bytes body(false);
    for (int i = 0; i < 255; ++i)
        body.add(std::cos(0.024f * static_cast<float>(i)))
            .add(std::sin(0.024f * static_cast<float>(i)))
            .add(0.0f);
    body.add<std::uint8_t>(255);
    for (int i = 0; i < 255; ++i)
        body.add(static_cast<std::uint8_t>(i));
    const Reading reading = read(header("binary_little_endian", lines) + body.text());
    EXPECT_EQ(reading.error, "");
    ASSERT_EQ(reading.mesh.triangles.size(), 253u);
    EXPECT_EQ(reading.mesh.triangles[252].a, 0u);
    EXPECT_EQ(reading.mesh.triangles[252].b, 253u);
    EXPECT_EQ(reading.mesh.triangles[252].c, 254u);
}

TEST(ReadPly, RefusesBadHeadersAtTheirLineAndColumn) {
    const std::string ok = "ply\nformat ascii 1.0\n";
    const struct {
        std::string text, error;
    } rows[] = {
        {"", "1:1: error: no PLY file (got '', expected 'ply')"},
        {"plx\n", "1:1: error: no PLY file (got 'plx'"},
        {"ply 2\n", "1:5: error: superfluous value (got '2'"},
        {"ply\n", "2:1: error: end_header is missing"},
        {"ply\nformat\n", "2:7: error: header line is too short (expected a format)"},
        {"ply\nformat ascii\n", "2:13: error: header line is too short (expected the version 1.0)"},
        {"ply\nformat utf8 1.0\n", "2:8: error: unknown PLY format (got 'utf8', expected ascii"},
        {"ply\nformat ascii 2.0\n",
         "2:14: error: unsupported PLY version (got '2.0', expected 1.0)"},
        {"ply\nelement vertex 3\n", "2:1: error: format is missing (got 'element'"},
        {ok + "format ascii 1.0\n", "3:1: error: unknown header line (got 'format'"},
        {ok + "property float x\n", "3:9: error: property before the first element"},
        {ok + "element vertex\n", "3:15: error: header line is too short (expected a count)"},
        {ok + "element vertex -1\n",
         "3:16: error: invalid count of elements (got '-1', expected an unsigned integer)"},
        {ok + "element vertex 1.5\n", "3:16: error: invalid count of elements (got '1.5'"},
        {ok + "element vertex 99999999999999999999\n",
         "3:16: error: invalid count of elements (got '9999"},
        {ok + "element vertex 3 4\n", "3:18: error: superfluous value (got '4'"},
        {ok + vertices + "element vertex 3\n", "7:9: error: element is given twice (got 'vertex')"},
        {ok + vertices + "property float x\n", "7:16: error: property is given twice (got 'x')"},
        {ok + "element vertex 3\nproperty half x\n", "4:10: error: unknown PLY type (got 'half'"},
        {ok + "element vertex 3\nproperty float\n",
         "4:15: error: header line is too short (expected a name)"},
        {ok + "element face 1\nproperty list float int vertex_indices\n",
         "4:15: error: list count is no integer"},
        {ok + "element face 1\nproperty list uchar\n",
         "4:20: error: header line is too short (expected a type)"},
        {ok + vertices + points,
         "7:1: error: unknown header line (got '0', expected element"}, // no end_header
        {ok + vertices, "7:1: error: end_header is missing (got the end of the file)"},
        {ok + vertices + "end_header x\n", "7:12: error: superfluous value (got 'x'"},
        {ok + face + "end_header\n3 0 1 2\n", "5:11: error: element 'vertex' is missing"},
        {ok + "element vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
         "3:16: error: element 'vertex' lacks a property x, y or z"},
        {ok + vertices + "element face 1\nproperty int vertex_indices\nend_header\n" + points +
             "0\n",
         "8:14: error: property 'vertex_indices' is no list of integers"},
        {ok + vertices + "element face 1\nproperty list uchar float vertex_index\nend_header\n" +
             points + "3 0 1 2\n",
         "8:27: error: property 'vertex_index' is no list of integers"},
        {ok + vertices + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
             points + "3 0 1 2\n",
         "7:19: error: triangle strips are not supported"},
        {"ply\rformat ascii 1.0\r", "1:5: error: superfluous value (got 'format'"}, // lone CRs
    };
    for (const auto& row : rows)
        EXPECT_EQ(read(row.text).error.find(row.error), 0u)
            << row.text << "\nexpected " << row.error << "\ngot      " << read(row.text).error;
}

TEST(ReadPly, ChecksCountsAgainstTheBytesBeforeItAllocates) {
    const std::string body(100, '\1');
    const struct {
        std::string format, lines, error;
    } rows[] = {
        {"binary_little_endian", "element vertex 4294967295\n" + xyz,
         "3:16: error: too few bytes for element 'vertex' (got 100, expected at least 4294967295 "
         "times 12)"},
        {"binary_little_endian", "element vertex 18446744073709551615\n" + xyz,
         "3:16: error: too few bytes for element 'vertex' (got 100"},
        {"binary_big_endian", "element vertex 9\n" + xyz,
         "3:16: error: too few bytes for element 'vertex' (got 100, expected at least 9 times 12)"},
        {"binary_little_endian",
         "element vertex 8\n" + xyz + "element face 5\nproperty list uchar int vertex_indices\n",
         "7:14: error: too few bytes for element 'face' (got 4, expected at least 5 times 1)"},
        {"binary_little_endian", "element junk 4294967295\nproperty double d\n" + vertices,
         "3:14: error: too few bytes for element 'junk'"},
        {"ascii", "element vertex 17\n" + xyz,
         "3:16: error: too few bytes for element 'vertex' (got 101, expected at least 17 times 6)"},
    };
    for (const auto& row : rows) {
        const Reading reading = read(header(row.format, row.lines) + body);
        EXPECT_EQ(reading.error.find(row.error), 0u) << row.lines << reading.error;
        EXPECT_LT(reading.seconds, 1.0);
    }
}

TEST(ReadPly, RefusesBadAsciiBodiesAtTheirLineAndColumn) {
    const std::string start = header("ascii", vertices + face); // 9 lines
    const struct {
        std::string body, error;
    } rows[] = {
        {"0 0 0\n1 0 0\n0 1\n3 0 1 2 \n", "12:4: error: number is missing"},
        {"0 0 0\n1 0 0\n0 1 0 5\n3 0 1 2\n",
         "12:7: error: superfluous value (got '5', expected the end of the row)"},
        {"0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", "10:5: error: invalid number (got 'nan'"},
        {"0 0 1,5\n1 0 0\n0 1 0\n3 0 1 2\n", "10:5: error: invalid number (got '1,5'"},
        {"0 0 1e999\n1 0 0\n0 1 0\n3 0 1 2\n", "10:5: error: invalid number (got '1e999'"},
        {"0 0 1e19\n1 0 0\n0 1 0\n3 0 1 2\n", "10:5: error: number is too large (got '1e19'"},
        {points + "\n\n\n", "16:1: error: body is truncated (got the end of the file)"},
        {points + "3 0 1 \n\n", "13:7: error: row is too short (got the end of the line)"},
        {points + "3 0 1 3\n", "13:7: error: invalid vertex index (got '3', expected less than 3)"},
        {points + "3 0 1 -1\n", "13:7: error: invalid vertex index (got '-1'"},
        {points + "3 0 1 4294967297\n", "13:7: error: invalid vertex index (got '4294967297'"},
        {points + "3 0 1 99999999999999999999\n",
         "13:7: error: invalid integer (got '99999999999999999999')"},
        {points + "3 0 1 2.5\n", "13:7: error: invalid integer (got '2.5')"},
        {points + "0\n", "13:1: error: face has too few vertices (got '0', expected at least 3)"},
        {points + "1 0\n", "13:1: error: face has too few vertices (got '1'"},
        {points + "2 0 1\n", "13:1: error: face has too few vertices (got '2'"},
        {points + "-3 0 1 2\n", "13:1: error: negative list count (got '-3')"},
        {points + "255 0 1 2\n", "13:10: error: row is too short"},
        {points + "9223372036854775807 0 1 2\n", "13:26: error: row is too short"},
    };
    for (const auto& row : rows)
        EXPECT_EQ(read(start + row.body).error.find(row.error), 0u)
            << row.body << "expected " << row.error << "\ngot      "
            << read(start + row.body).error;
}

TEST(ReadPly, RefusesBadBinaryBodiesAtTheirByte) {
    const std::string start = header("binary_little_endian", vertices + face);
    const auto floats = [](float last) {
        Bytes bytes(false);
        for (const float x : {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, last})
            bytes.add(x);
        return bytes;
    };
    const auto at = [&](std::size_t byte) {
        return " at byte " + std::to_string(start.size() + byte);
    };
    const float inf = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto polygon = [&](std::uint8_t count, std::vector<std::int32_t> indices) {
        Bytes bytes = floats(0);
        bytes.add(count);
        for (const std::int32_t i : indices)
            bytes.add(i);
        return start + bytes.text();
    };
    const struct {
        std::string text, error;
    } rows[] = {
        {start + floats(nan).add<std::uint8_t>(3).text(),
         " error: invalid number (got 'nan', expected a finite one of at most 1.8e18)" + at(32)},
        {start + floats(-inf).add<std::uint8_t>(3).text(), " error: invalid number (got '-inf'"},
        {start + floats(1e19f).add<std::uint8_t>(3).text(),
         " error: invalid number (got '9999999980506447872.000000'"},
        {polygon(0, {}),
         " error: face has too few vertices (got '0', expected at least 3)" + at(36)},
        {polygon(1, {0}), " error: face has too few vertices (got '1'"},
        {polygon(2, {0, 1}), " error: face has too few vertices (got '2'"},
        {polygon(3, {0, 1, 3}),
         " error: invalid vertex index (got '3', expected less than 3)" + at(45)},
        {polygon(3, {0, -1, 2}),
         " error: invalid vertex index (got '-1', expected less than 3)" + at(41)},
        {polygon(3, {0, 1}), " error: body is truncated" + at(45)},
        {polygon(255, {0, 1, 2}), " error: body is truncated" + at(49)},
    };
    for (const auto& row : rows)
        EXPECT_EQ(read(row.text).error.find(row.error), 0u)
            << "expected " << row.error << "\ngot      " << read(row.text).error;
}

TEST(ReadPly, SurvivesEveryTruncation) {
    Bytes body(true);
    for (const float x : {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f})
        body.add(x);
    body.add<std::uint8_t>(3).add(0).add(1).add(2);
    const std::string binary = header("binary_big_endian", vertices + face) + body.text();
    for (std::size_t length = 0; length < binary.size(); ++length)
        EXPECT_NE(read(binary.substr(0, length)).error, "") << length;
    const std::string ascii = header("ascii", vertices + face) + points + "3 0 1 2";
    for (std::size_t length = 0; length < ascii.size(); ++length)
        EXPECT_NE(read(ascii.substr(0, length)).error, "") << length;
    expect_triangle(read(binary), "whole");
    expect_triangle(read(ascii), "whole");
}

TEST(ReadPly, WarnsWithTheCountOfWhatItDrops) {
    const std::string normals = "property float nx\nproperty float ny\nproperty float nz\n";
    const struct {
        std::string text, warning;
    } rows[] = {
        {header("ascii", vertices) + points, "the mesh has no triangles"},
        {header("ascii", vertices + "element face 0\nproperty list uchar int vertex_indices\n") +
             points,
         "the mesh has no triangles"},
        {header("ascii", vertices + "element face 1\nproperty uchar flag\n") + points + "1\n",
         "the mesh has no triangles"},
        {header("ascii", vertices + face) + points + "3 0 0 1\n",
         "1 of 1 triangles have no area and are dropped"},
        {header("ascii", vertices + face) + "0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n",
         "1 of 1 triangles have no area"},
        {header("ascii", vertices + face) + points + "3 0 1 2\nmore\n",
         "4 bytes after the last element are ignored"},
        {header("ascii", vertices + normals + face) +
             "0 0 0 0 0 0\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n",
         "1 vertex normals are zero and are replaced"},
        {header("ascii", vertices + normals + face) +
             "0 0 0 0 0 -1\n1 0 0 0 0 -1\n0 1 0 0 0 -1\n3 0 1 2\n",
         "1 triangles are wound against their vertex normals"},
    };
    for (const auto& row : rows) {
        const Reading reading = read(row.text);
        EXPECT_EQ(reading.error, "") << row.text;
        ASSERT_FALSE(reading.warnings.empty()) << row.text;
        EXPECT_EQ(reading.warnings[0].find(file + ": warning: " + row.warning), 0u)
            << row.text << reading.warnings[0];
    }
}

} // namespace
} // namespace plumb
