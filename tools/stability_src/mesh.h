/// \file  The meshes that rays are aimed at, with their edges and neighbourhoods.
#pragma once

#include "accel/geometry.h"
#include "tools/stability_src/random.h"

#include <functional>
#include <vector>

namespace plumb::stability {

/// A point in double, before it becomes a vertex.
struct Point {
    double x, y, z;
};

/// An indexed mesh with what it takes to aim at it.
struct Mesh {
    struct Edge {
        std::uint32_t a, b;
    };

    std::vector<Vec3> positions;
    std::vector<Triangle> triangles;
    std::vector<Edge> edges;                        ///< shared by two triangles, each once
    std::vector<std::uint32_t> vertices;            ///< all of whose edges are shared
    std::vector<std::vector<std::uint32_t>> around; ///< triangles at each vertex

    [[nodiscard]] MeshView view() const { return {positions, triangles}; }
    /// Fills in edges, vertices and around.
    void connect();
};

/// Closed sphere of radius 1 with 4 rings (rings - 1) triangles, every vertex moved by `place`
/// (in double) and rounded once.
[[nodiscard]] Mesh closed_sphere(std::uint32_t rings, const std::function<Point(Point)>& place);

/// Square of cells x cells quads in z = 0, edge length `size`, centre at the origin.
[[nodiscard]] Mesh plane(float size, std::uint32_t cells);

} // namespace plumb::stability
