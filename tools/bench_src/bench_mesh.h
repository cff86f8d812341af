/// \file  The mesh that a benchmark traces, and the camera and light that its rays come from.
#pragma once

#include "accel/geometry.h"

#include <string>
#include <vector>

namespace plumb::bench {

/// Where the rays of a mesh begin: a pinhole camera and a spherical area light (which is not part
/// of the mesh). World units.
struct Viewpoint {
    Vec3 eye, target;
    Vec3 up{0, 1, 0};
    float fov_x_deg = 60;
    Vec3 light;
    float light_radius = 0.1f;
};

struct BenchMesh {
    std::string name;
    std::vector<Vec3> positions;
    std::vector<Triangle> triangles;
    Viewpoint view;
    /// How many rays its sets have at most: fewer where a ray is slow.
    std::size_t coherent_rays = std::size_t{1} << 20u;
    std::size_t incoherent_rays = std::size_t{1} << 18u;

    [[nodiscard]] MeshView mesh_view() const { return {positions, triangles}; }

    std::uint32_t add_vertex(Vec3 p) {
        positions.push_back(p);
        return static_cast<std::uint32_t>(positions.size() - 1);
    }
    void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        triangles.push_back({a, b, c});
    }
    /// Two triangles; corners around the quad.
    void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        add_triangle(a, b, c);
        add_triangle(a, c, d);
    }
    void add_quad(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
        const std::uint32_t first = add_vertex(a);
        add_vertex(b);
        add_vertex(c);
        add_quad(first, first + 1, first + 2, add_vertex(d));
    }
    /// The triangles of a grid of rows x columns vertices that are stored row by row from `first`.
    /// A closed grid joins its last column to its first.
    void add_grid(std::uint32_t first, std::uint32_t rows, std::uint32_t columns, bool closed);
};

/// FNV-1a over all positions and indices: equal meshes, equal hashes.
[[nodiscard]] std::uint64_t hash_of(const BenchMesh& mesh);

/// The box around all positions.
[[nodiscard]] Bounds bounds_of(const BenchMesh& mesh);

} // namespace plumb::bench
