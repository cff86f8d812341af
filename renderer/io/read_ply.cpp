/// \file  PLY meshes: one walk over the rows, written once for ASCII and binary bodies.
#include "renderer/io/read_ply.h"

#include "renderer/io/finish_mesh.h"
#include "renderer/io/input_file.h"
#include "renderer/io/ply_body.h"

#include <array>

namespace plumb {
namespace {

/// What a property of a vertex means; the order is that of its values below.
enum Slot : std::size_t { x, y, z, nx, ny, nz, u, v, slot_count };
using VertexValues = std::array<float, slot_count>;

/// A property and where its value goes, slot_count: nowhere.
struct Column {
    PlyType type;
    std::optional<PlyType> count_type;
    std::size_t slot = slot_count;
};

struct VertexLayout {
    std::vector<Column> columns;
    bool has_position = false, has_normal = false, has_uv = false;
};

VertexLayout layout_of(const PlyElement& vertex) {
    VertexLayout layout;
    for (const PlyProperty& p : vertex.properties)
        layout.columns.push_back({p.type, p.count_type});
    const auto assign = [&](std::initializer_list<std::string_view> names, std::size_t first) {
        for (const std::string_view name : names) {
            const PlyProperty* const p = vertex.find(name);
            if (!p || p->count_type)
                return false;
        }
        for (const std::string_view name : names) {
            const auto index =
                static_cast<std::size_t>(vertex.find(name) - vertex.properties.data());
            layout.columns[index].slot = first++;
        }
        return true;
    };
    layout.has_position = assign({"x", "y", "z"}, x);
    layout.has_normal = assign({"nx", "ny", "nz"}, nx);
    layout.has_uv = assign({"u", "v"}, u) || assign({"s", "t"}, u) ||
                    assign({"texture_u", "texture_v"}, u) || assign({"texture_s", "texture_t"}, u);
    return layout;
}

/// Reads the elements of one body.
template <class Body> class PlyReader {
  public:
    PlyReader(const PlyHeader& header, Body& body, Mesh& mesh)
        : header_(header), body_(body), mesh_(mesh), vertex_count_(header.find("vertex")->count) {}

    void read() {
        for (const PlyElement& element : header_.elements) {
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face")
                read_faces(element);
            else
                skip_element(element);
        }
    }
    [[nodiscard]] std::size_t degenerate() const { return degenerate_; }

  private:
    void read_vertices(const PlyElement& element);
    void read_faces(const PlyElement& element);
    void skip_element(const PlyElement& element);
    void read_polygon(const PlyProperty& list);
    void skip(PlyType type, std::optional<PlyType> count_type);
    [[nodiscard]] std::uint64_t list_count(PlyType type);

    const PlyHeader& header_;
    Body& body_;
    Mesh& mesh_;
    std::uint64_t vertex_count_;
    std::size_t degenerate_ = 0;
};

template <class Body> std::uint64_t PlyReader<Body>::list_count(PlyType type) {
    const auto place = body_.place();
    const long long count = body_.integer(type);
    if (count < 0)
        body_.refuse_at(place, "negative list count (got '" + std::to_string(count) + "')");
    return static_cast<std::uint64_t>(count);
}

template <class Body> void PlyReader<Body>::skip(PlyType type, std::optional<PlyType> count_type) {
    body_.skip(type, count_type ? list_count(*count_type) : 1);
}

template <class Body> void PlyReader<Body>::skip_element(const PlyElement& element) {
    if (element.properties.empty()) // rows of nothing, however many
        return;
    for (std::uint64_t row = 0; row < element.count; ++row) {
        body_.begin_row();
        for (const PlyProperty& p : element.properties)
            skip(p.type, p.count_type);
        body_.end_row();
    }
}

template <class Body> void PlyReader<Body>::read_vertices(const PlyElement& element) {
    const VertexLayout layout = layout_of(element);
    const auto count = static_cast<std::size_t>(element.count);
    mesh_.positions.reserve(count);
    mesh_.normals.reserve(layout.has_normal ? count : 0);
    mesh_.uvs.reserve(layout.has_uv ? count : 0);
    VertexValues values{};
    for (std::size_t row = 0; row < count; ++row) {
        body_.begin_row();
        for (const Column& column : layout.columns) {
            if (column.slot != slot_count)
                values[column.slot] = body_.number(column.type);
            else
                skip(column.type, column.count_type);
        }
        body_.end_row();
        mesh_.positions.push_back({values[x], values[y], values[z]});
        if (layout.has_normal)
            mesh_.normals.push_back({values[nx], values[ny], values[nz]});
        if (layout.has_uv)
            mesh_.uvs.push_back({values[u], values[v]});
    }
}

template <class Body> void PlyReader<Body>::read_faces(const PlyElement& element) {
    const PlyProperty* indices = element.find("vertex_indices");
    if (!indices)
        indices = element.find("vertex_index");
    if (!indices)
        return skip_element(element);
    mesh_.triangles.reserve(static_cast<std::size_t>(element.count));
    for (std::uint64_t row = 0; row < element.count; ++row) {
        body_.begin_row();
        for (const PlyProperty& p : element.properties) {
            if (&p == indices)
                read_polygon(p);
            else
                skip(p.type, p.count_type);
        }
        body_.end_row();
    }
}

/// A fan around the first vertex.
template <class Body> void PlyReader<Body>::read_polygon(const PlyProperty& list) {
    const auto list_place = body_.place();
    const std::uint64_t count = list_count(*list.count_type);
    if (count < 3)
        body_.refuse_at(list_place, "face has too few vertices (got '" + std::to_string(count) +
                                        "', expected at least 3)");
    const auto read_index = [&] {
        const auto place = body_.place();
        const long long index = body_.integer(list.type);
        if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count_)
            body_.refuse_at(place, "invalid vertex index (got '" + std::to_string(index) +
                                       "', expected less than " + std::to_string(vertex_count_) +
                                       ")");
        return static_cast<std::uint32_t>(index);
    };
    const std::uint32_t first = read_index();
    std::uint32_t previous = read_index();
    for (std::uint64_t i = 2; i < count; ++i) {
        const std::uint32_t current = read_index();
        if (first == previous || previous == current || current == first)
            ++degenerate_;
        else
            mesh_.triangles.push_back({first, previous, current});
        previous = current;
    }
}

/// What the header must have for a mesh.
void check_header(const LineCursor& text, const PlyHeader& header) {
    const PlyElement* const vertex = header.find("vertex");
    if (!vertex)
        text.refuse("element 'vertex' is missing");
    if (!layout_of(*vertex).has_position)
        text.refuse(vertex->count_at, "element 'vertex' lacks a property x, y or z");
    if (vertex->count >= invalid_id)
        text.refuse(vertex->count_at, "too many vertices (got '" + std::to_string(vertex->count) +
                                          "', expected at most 4294967294)");
    const PlyElement* const face = header.find("face");
    for (const char* const name : {"vertex_indices", "vertex_index"}) {
        const PlyProperty* const p = face ? face->find(name) : nullptr;
        if (p && (!p->count_type || !is_integer(p->type)))
            text.refuse(p->at, std::string("property '") + name + "' is no list of integers");
    }
    const PlyElement* const strips = header.find("tristrips");
    if (!face && strips)
        text.refuse(strips->count_at, "triangle strips are not supported (expected faces)");
}

} // namespace

Mesh read_ply(const std::filesystem::path& file, std::vector<std::string>& warnings) {
    const MappedFile mapped(file, ErrorKind::mesh);
    return read_ply_text(file, mapped.text(), warnings);
}

Mesh read_ply_text(const std::filesystem::path& file, std::string_view bytes,
                   std::vector<std::string>& warnings) {
    LineCursor text(file.string(), bytes);
    const PlyHeader header = read_ply_header(text);
    check_header(text, header);
    Mesh mesh;
    mesh.name = file.filename().string();
    std::size_t degenerate = 0, trailing = 0;
    const auto read_body = [&](auto body) {
        PlyReader reader(header, body, mesh);
        reader.read();
        degenerate = reader.degenerate();
        trailing = body.trailing_bytes();
    };
    if (header.format == PlyFormat::ascii)
        read_body(PlyAsciiBody(text));
    else
        read_body(PlyBinaryBody(file.string(), bytes, text.rest(), header.format));
    if (trailing > 0)
        warnings.push_back(file.string() + ": warning: " + std::to_string(trailing) +
                           " bytes after the last element are ignored");
    finish_mesh(mesh, file.string(), degenerate, warnings);
    return mesh;
}

} // namespace plumb
