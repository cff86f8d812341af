/// \file  Geometry that the tests trace: closed, open, degenerate and deep.
#pragma once

#include "accel/geometry.h"
#include "tests/support/random.h"

#include <array>
#include <functional>
#include <vector>

namespace plumb::test {

/// An indexed mesh that owns its vectors.
struct Mesh {
    std::vector<Vec3> positions;
    std::vector<Triangle> triangles;

    void add_triangle(Vec3 a, Vec3 b, Vec3 c);
    [[nodiscard]] MeshView view() const { return {positions, triangles}; }
};

/// Meshes and spheres together, owned. Add everything, then take view(): it is valid while the
/// object lives, also after a move, and until the next add.
class TestGeometry {
  public:
    TestGeometry() = default;
    explicit TestGeometry(Mesh mesh) { add(std::move(mesh)); }
    TestGeometry(TestGeometry&&) = default;
    TestGeometry& operator=(TestGeometry&&) = default;

    void add(Mesh mesh);
    void add(const Sphere& sphere) { spheres_.push_back(sphere); }
    [[nodiscard]] GeometryView view() const { return {views_, spheres_}; }
    [[nodiscard]] const std::vector<Mesh>& meshes() const { return meshes_; }
    [[nodiscard]] const std::vector<Sphere>& spheres() const { return spheres_; }

  private:
    std::vector<Mesh> meshes_;
    std::vector<MeshView> views_;
    std::vector<Sphere> spheres_;
};

/// Two vertex indices of one mesh.
struct Edge {
    std::uint32_t a, b;
};

/// Closed sphere of `rings` x 2 rings quads, one shared vertex at each pole, counter-clockwise
/// seen from outside. `radius_at` scales the radius along a unit direction; it must be positive.
[[nodiscard]] Mesh
closed_sphere(Vec3 center, float radius, std::uint32_t rings,
              const std::function<double(double, double, double)>& radius_at = {});

/// A bumpy closed sphere of 4 rings (rings - 1) triangles: a stand-in for a scanned mesh.
[[nodiscard]] Mesh displaced_sphere(Vec3 center, float radius, std::uint32_t rings);

/// Square of cells x cells quads in the plane z = center.z, edge length `size`.
[[nodiscard]] Mesh plane(Vec3 center, float size, std::uint32_t cells);

/// Axis-aligned closed box of 12 triangles; shared vertices.
[[nodiscard]] Mesh box(Vec3 lower, Vec3 upper);

/// Unconnected triangles with centres in [-1,1]^3 and edges of about `size`.
[[nodiscard]] Mesh triangle_soup(Random& random, std::size_t count, float size);

/// Unconnected long thin triangles: length about 1, width about `width`.
[[nodiscard]] Mesh needles(Random& random, std::size_t count, float width);

/// Boxes i = 0 .. count-1 with lower corner 2^i and edge 2^(i-2): a split by position peels one
/// box off at a time.
[[nodiscard]] Mesh boxes_at_powers_of_two(int count);

/// count boxes around the origin, each inside the next.
[[nodiscard]] Mesh nested_boxes(std::size_t count);

/// `copies` times the same triangle, each with vertices of its own.
[[nodiscard]] Mesh repeated_triangle(std::size_t copies);

/// side^3 spheres of the given radius at the integer points 0 .. side-1.
[[nodiscard]] std::vector<Sphere> sphere_grid(std::uint32_t side, float radius);

/// Soup, needles, a closed sphere, a box and spheres in one scene of several geometries.
[[nodiscard]] TestGeometry mixed_scene(std::uint64_t seed);

/// Edges that two triangles or more share (by vertex index), each once.
[[nodiscard]] std::vector<Edge> shared_edges(const Mesh& mesh);

/// Vertices all of whose edges are shared.
[[nodiscard]] std::vector<std::uint32_t> inner_vertices(const Mesh& mesh);

} // namespace plumb::test
