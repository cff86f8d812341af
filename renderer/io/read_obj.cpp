/// \file  Wavefront OBJ meshes: one pass over the mapped file, std::from_chars on its bytes.
#include "renderer/io/read_obj.h"

#include "renderer/io/finish_mesh.h"
#include "renderer/io/input_file.h"
#include "renderer/io/line_cursor.h"
#include "renderer/io/obj_faces.h"
#include "renderer/io/text_position.h"

#include <algorithm>
#include <array>

namespace plumb {
namespace {

constexpr std::array<std::string_view, 17> ignored_statements = {
    "g",      "o",      "s",   "usemtl", "mtllib",   "l",        "p",          "vp",       "mg",
    "usemap", "maplib", "lod", "bevel",  "c_interp", "d_interp", "shadow_obj", "trace_obj"};

/// Positions, texture coordinates or normals: the values, and what the faces have said of them.
template <class Value> struct Indexed {
    const char* noun;
    std::vector<Value> values;
    /// Indices may point forwards, so that the largest (from 1; 0: none) is checked at the end.
    std::uint32_t largest = 0;
    const char* largest_at = nullptr;
    std::size_t corners = 0; ///< that have such an index
};

/// Reads the statements of one file.
class ObjReader {
  public:
    ObjReader(const std::filesystem::path& file, std::string_view text,
              std::vector<std::string>& warnings)
        : file_(file.string()), line_(file_, text), warnings_(warnings) {}

    [[nodiscard]] Mesh read();

  private:
    void read_statement();
    void read_position();
    void read_uv();
    void read_normal();
    void read_face();
    [[nodiscard]] ObjCorner read_corner();
    template <class Value> [[nodiscard]] std::uint32_t read_index(Indexed<Value>& kind);
    template <class Value> [[noreturn]] void refuse_index(const Indexed<Value>&, const char* at);

    template <class Value> void check_largest(const Indexed<Value>& kind);
    void warn_of_gaps();
    [[nodiscard]] Mesh assemble();
    void assemble_direct(Mesh& mesh);
    void assemble_corners(Mesh& mesh) const;

    std::string file_;
    LineCursor line_;
    std::vector<std::string>& warnings_;
    Indexed<Vec3> positions_{"vertex", {}}, normals_{"normal", {}};
    Indexed<Vec2> uvs_{"texture coordinate", {}};
    std::vector<ObjCorner> polygon_; ///< reused
    ObjFaces faces_;
    std::size_t corner_count_ = 0;
    std::size_t unknown_count_ = 0;
    std::string first_unknown_;
};

// --- statements ----------------------------------------------------------------------------------

void ObjReader::read_statement() {
    if (line_.at_line_end())
        return;
    const std::string_view keyword = line_.token();
    const auto geometry = [&](void (ObjReader::*read_values)()) {
        line_.join_continued_lines();
        line_.advance(keyword.size());
        (this->*read_values)();
    };
    if (keyword == "v")
        return geometry(&ObjReader::read_position);
    if (keyword == "f")
        return geometry(&ObjReader::read_face);
    if (keyword == "vn")
        return geometry(&ObjReader::read_normal);
    if (keyword == "vt")
        return geometry(&ObjReader::read_uv);
    const auto end = ignored_statements.end();
    if (std::find(ignored_statements.begin(), end, keyword) == end && unknown_count_++ == 0)
        first_unknown_ = std::string("'") + printable(keyword) + "' in line " +
                         std::to_string(line_.line_of(line_.at()));
}

void ObjReader::read_position() {
    const float x = line_.read_float(), y = line_.read_float(), z = line_.read_float();
    positions_.values.push_back({x, y, z});
    for (int extra = 0; extra < 5 && !line_.at_line_end(); ++extra) // w, r g b, w r g b, r g b a...
        static_cast<void>(line_.read_float());
    line_.expect_line_end("x y z and at most 5 numbers more");
}

void ObjReader::read_normal() {
    const float x = line_.read_float(), y = line_.read_float(), z = line_.read_float();
    normals_.values.push_back({x, y, z});
    line_.expect_line_end("x y z");
}

void ObjReader::read_uv() {
    const float u = line_.read_float();
    const float v = line_.at_line_end() ? 0 : line_.read_float();
    uvs_.values.push_back({u, v});
    if (!line_.at_line_end())
        static_cast<void>(line_.read_float());
    line_.expect_line_end("u v w");
}

void ObjReader::read_face() {
    const char* const start = line_.at() - 1; // the `f`
    polygon_.clear();
    while (!line_.at_line_end())
        polygon_.push_back(read_corner());
    if (polygon_.size() < 3)
        line_.refuse(start, "face has too few corners (got '" + std::to_string(polygon_.size()) +
                                "', expected at least 3)");
    corner_count_ += polygon_.size();
    faces_.add(polygon_);
}

ObjCorner ObjReader::read_corner() {
    const char* const start = line_.at();
    ObjCorner corner;
    corner.position = read_index(positions_);
    if (line_.peek() == '/') {
        line_.advance(1);
        if (line_.peek() != '/' && !line_.at_separator())
            corner.uv = read_index(uvs_);
        if (line_.peek() == '/') {
            line_.advance(1);
            if (!line_.at_separator())
                corner.normal = read_index(normals_);
        }
    }
    if (!line_.at_separator())
        line_.refuse(start, "invalid corner of a face (got '" + printable(line_.token_from(start)) +
                                "', expected v, v/vt, v//vn or v/vt/vn)");
    return corner;
}

template <class Value> std::uint32_t ObjReader::read_index(Indexed<Value>& kind) {
    const char* const start = line_.at();
    const auto index = line_.read_integer();
    const auto count = static_cast<long long>(kind.values.size());
    if (!index || *index == 0 || *index >= invalid_id || *index < -count)
        refuse_index(kind, start);
    const auto from_one = static_cast<std::uint32_t>(*index > 0 ? *index : count + *index + 1);
    if (from_one > kind.largest) {
        kind.largest = from_one;
        kind.largest_at = start;
    }
    ++kind.corners;
    return from_one - 1;
}

template <class Value> void ObjReader::refuse_index(const Indexed<Value>& kind, const char* at) {
    const std::string_view corner = line_.token_from(at);
    const std::string index = printable(corner.substr(0, corner.find('/')));
    const std::string count = std::to_string(kind.values.size());
    const std::string range = kind.values.empty() ? std::string("none: there is none yet")
                                                  : "1 to " + count + " or -" + count + " to -1";
    line_.refuse(at, std::string("invalid ") + kind.noun + " index (got '" + index +
                         "', expected " + range + ")");
}

// --- the whole -----------------------------------------------------------------------------------

Mesh ObjReader::read() {
    while (line_.next_line())
        read_statement();
    check_largest(positions_);
    check_largest(uvs_);
    check_largest(normals_);
    warn_of_gaps();
    Mesh mesh = assemble();
    finish_mesh(mesh, file_, faces_.degenerate(), warnings_);
    return mesh;
}

template <class Value> void ObjReader::check_largest(const Indexed<Value>& kind) {
    if (kind.largest > kind.values.size())
        refuse_index(kind, kind.largest_at);
}

void ObjReader::warn_of_gaps() {
    const auto warn = [&](std::size_t count, const std::string& what) {
        if (count > 0)
            warnings_.push_back(file_ + ": warning: " + std::to_string(count) + what);
    };
    const std::string of_all =
        " of " + std::to_string(corner_count_) + " corners of faces have no ";
    warn(unknown_count_, " unknown statements are ignored (the first: " + first_unknown_ + ")");
    if (normals_.corners > 0)
        warn(corner_count_ - normals_.corners, of_all + "normal: all normals are ignored");
    if (uvs_.corners > 0)
        warn(corner_count_ - uvs_.corners, of_all + "texture coordinate: they get (0,0)");
}

Mesh ObjReader::assemble() {
    Mesh mesh;
    mesh.name = std::filesystem::path(file_).filename().string();
    mesh.triangles = std::move(faces_.triangles());
    if (faces_.is_direct())
        assemble_direct(mesh);
    else
        assemble_corners(mesh);
    return mesh;
}

/// Position, uv and normal i belong together; what is missing of unused vertices is filled up.
void ObjReader::assemble_direct(Mesh& mesh) {
    mesh.positions = std::move(positions_.values);
    if (uvs_.corners > 0) {
        mesh.uvs = std::move(uvs_.values);
        mesh.uvs.resize(mesh.positions.size());
    }
    if (normals_.corners > 0) {
        mesh.normals = std::move(normals_.values);
        mesh.normals.resize(mesh.positions.size(), {0, 0, 1});
    }
}

void ObjReader::assemble_corners(Mesh& mesh) const {
    const bool with_uv = uvs_.corners > 0, with_normal = normals_.corners == corner_count_;
    const std::vector<ObjCorner>& corners = faces_.corners();
    mesh.positions.reserve(corners.size());
    mesh.uvs.reserve(with_uv ? corners.size() : 0);
    mesh.normals.reserve(with_normal ? corners.size() : 0);
    for (const ObjCorner& c : corners) {
        mesh.positions.push_back(positions_.values[c.position]);
        if (with_uv)
            mesh.uvs.push_back(c.uv == invalid_id ? Vec2{} : uvs_.values[c.uv]);
        if (with_normal)
            mesh.normals.push_back(normals_.values[c.normal]);
    }
}

} // namespace

Mesh read_obj(const std::filesystem::path& file, std::vector<std::string>& warnings) {
    const MappedFile mapped(file, ErrorKind::mesh);
    return read_obj_text(file, mapped.text(), warnings);
}

Mesh read_obj_text(const std::filesystem::path& file, std::string_view text,
                   std::vector<std::string>& warnings) {
    return ObjReader(file, text, warnings).read();
}

} // namespace plumb
