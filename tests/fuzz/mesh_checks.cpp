#include "tests/fuzz/mesh_checks.h"

#include "tests/fuzz/finding.h"

#include <algorithm>
#include <cmath>

namespace plumb::fuzz {
namespace {

bool is_unit(Vec3 n) { return std::fabs(length(n) - 1) < 1e-5f; }

} // namespace

void require_sound(const Mesh& mesh) {
    const std::size_t count = mesh.positions.size();
    require(std::all_of(mesh.positions.begin(), mesh.positions.end(), is_finite),
            "a mesh with a position that is not finite");
    require(mesh.normals.empty() || mesh.normals.size() == count, "normals, not one a vertex");
    require(mesh.uvs.empty() || mesh.uvs.size() == count, "texture coordinates, not one a vertex");
    require(std::all_of(mesh.uvs.begin(), mesh.uvs.end(),
                        [](Vec2 uv) { return std::isfinite(uv.x) && std::isfinite(uv.y); }),
            "texture coordinates that are not finite");
    for (const Triangle& t : mesh.triangles) {
        require(t.a < count && t.b < count && t.c < count, "a vertex index out of range");
        require(mesh.positions[t.a] != mesh.positions[t.b] &&
                    mesh.positions[t.b] != mesh.positions[t.c] &&
                    mesh.positions[t.c] != mesh.positions[t.a],
                "a triangle with two equal corners");
        require(mesh.normals.empty() || (is_unit(mesh.normals[t.a]) && is_unit(mesh.normals[t.b]) &&
                                         is_unit(mesh.normals[t.c])),
                "a normal of a triangle that is no unit vector");
    }
}

void require_well_formed(const SceneError& error) {
    const std::string what = error.what();
    require(what.find(": error: ") != std::string::npos, "a message without a place: " + what);
    // Bytes above 0x7F are letters of other scripts.
    require(std::none_of(what.begin(), what.end(),
                         [](char c) { return (c >= 0 && c < ' ' && c != '\n') || c == 0x7F; }),
            "a message with control characters: " + what);
    for (std::size_t end = what.find('\n'); end != std::string::npos;
         end = what.find('\n', end + 1))
        require(what.compare(end, 16, "\n  included from") == 0, "a message of two lines: " + what);
}

void require_reads_or_refuses(MeshReader read, const std::uint8_t* data, std::size_t size) {
    const std::vector<char> bytes(data, data + size);
    std::vector<std::string> warnings;
    try {
        require_sound(read("fuzz.mesh", {bytes.data(), bytes.size()}, warnings));
    } catch (const SceneError& error) {
        require(error.kind() == ErrorKind::mesh, "a mesh that is not refused as a mesh");
        require_well_formed(error);
    }
}

} // namespace plumb::fuzz
