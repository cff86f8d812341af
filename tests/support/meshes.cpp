#include "tests/support/meshes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace plumb::test {
namespace {

constexpr double pi_double = 3.14159265358979323846;

Vec3 offset(Vec3 center, double x, double y, double z) {
    return {static_cast<float>(static_cast<double>(center.x) + x),
            static_cast<float>(static_cast<double>(center.y) + y),
            static_cast<float>(static_cast<double>(center.z) + z)};
}

std::uint32_t size_of(const std::vector<Vec3>& v) { return static_cast<std::uint32_t>(v.size()); }

void append(Mesh& mesh, const Mesh& other) {
    const std::uint32_t base = size_of(mesh.positions);
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    for (const Triangle t : other.triangles)
        mesh.triangles.push_back({t.a + base, t.b + base, t.c + base});
}

/// How many triangles use each edge, keyed by the ordered pair of vertices.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> edge_uses(const Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const Triangle t : mesh.triangles) {
        ++uses[std::minmax(t.a, t.b)];
        ++uses[std::minmax(t.b, t.c)];
        ++uses[std::minmax(t.c, t.a)];
    }
    return uses;
}

} // namespace

void Mesh::add_triangle(Vec3 a, Vec3 b, Vec3 c) {
    const std::uint32_t base = size_of(positions);
    positions.insert(positions.end(), {a, b, c});
    triangles.push_back({base, base + 1, base + 2});
}

void TestGeometry::add(Mesh mesh) {
    meshes_.push_back(std::move(mesh));
    views_.clear();
    for (const Mesh& m : meshes_)
        views_.push_back(m.view());
}

Mesh closed_sphere(Vec3 center, float radius, std::uint32_t rings,
                   const std::function<double(double, double, double)>& radius_at) {
    Mesh mesh;
    const std::uint32_t columns = 2 * rings;
    const auto add = [&](std::uint32_t ring, std::uint32_t column) {
        const double theta = pi_double * ring / rings, phi = 2 * pi_double * column / columns;
        const bool pole = ring == 0 || ring == rings;
        const double s = pole ? 0 : std::sin(theta);
        const double x = s * std::cos(phi), y = s * std::sin(phi), z = std::cos(theta);
        const double r = static_cast<double>(radius) * (radius_at ? radius_at(x, y, z) : 1.0);
        mesh.positions.push_back(offset(center, r * x, r * y, r * z));
    };
    add(0, 0);
    for (std::uint32_t ring = 1; ring < rings; ++ring)
        for (std::uint32_t column = 0; column < columns; ++column)
            add(ring, column);
    add(rings, 0);
    const std::uint32_t last = size_of(mesh.positions) - 1;
    const auto at = [&](std::uint32_t ring, std::uint32_t column) {
        return ring == 0 ? 0 : ring == rings ? last : 1 + (ring - 1) * columns + column % columns;
    };
    for (std::uint32_t ring = 0; ring < rings; ++ring)
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t a = at(ring, column), b = at(ring + 1, column),
                                c = at(ring + 1, column + 1), d = at(ring, column + 1);
            if (ring + 1 < rings)
                mesh.triangles.push_back({a, b, c});
            if (ring > 0)
                mesh.triangles.push_back({a, c, d});
        }
    return mesh;
}

Mesh displaced_sphere(Vec3 center, float radius, std::uint32_t rings) {
    return closed_sphere(center, radius, rings, [](double x, double y, double z) {
        return 1 + 0.1 * std::sin(9 * x) * std::sin(8 * y + 1) * std::sin(7 * z + 2) +
               0.02 * std::sin(57 * x) * std::cos(49 * y) * std::cos(61 * z);
    });
}

Mesh plane(Vec3 center, float size, std::uint32_t cells) {
    Mesh mesh;
    const auto position = [&](std::uint32_t i) {
        return static_cast<double>(size) * (static_cast<double>(i) / cells - 0.5);
    };
    for (std::uint32_t j = 0; j <= cells; ++j)
        for (std::uint32_t i = 0; i <= cells; ++i)
            mesh.positions.push_back(offset(center, position(i), position(j), 0));
    for (std::uint32_t j = 0; j < cells; ++j)
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t a = j * (cells + 1) + i, b = a + 1, d = a + cells + 1, c = d + 1;
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
        }
    return mesh;
}

Mesh box(Vec3 lower, Vec3 upper) {
    Mesh mesh;
    for (unsigned corner = 0; corner < 8; ++corner)
        mesh.positions.push_back({(corner & 1u) != 0 ? upper.x : lower.x,
                                  (corner & 2u) != 0 ? upper.y : lower.y,
                                  (corner & 4u) != 0 ? upper.z : lower.z});
    const std::array<std::array<std::uint32_t, 4>, 6> quads{
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    for (const auto& q : quads) {
        mesh.triangles.push_back({q[0], q[1], q[2]});
        mesh.triangles.push_back({q[0], q[2], q[3]});
    }
    return mesh;
}

Mesh triangle_soup(Random& random, std::size_t count, float size) {
    Mesh mesh;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 center = random.point(-1, 1);
        const Vec3 a = center + random.point(-size, size);
        const Vec3 b = center + random.point(-size, size);
        mesh.add_triangle(a, b, center + random.point(-size, size));
    }
    return mesh;
}

Mesh needles(Random& random, std::size_t count, float width) {
    Mesh mesh;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 a = random.point(-1, 1);
        const Vec3 b = a + random.direction();
        mesh.add_triangle(a, b, b + width * random.direction());
    }
    return mesh;
}

Mesh boxes_at_powers_of_two(int count) {
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const float p = std::ldexp(1.0f, i);
        append(mesh, box({p, p, p}, {1.25f * p, 1.25f * p, 1.25f * p}));
    }
    return mesh;
}

Mesh nested_boxes(std::size_t count) {
    Mesh mesh;
    for (std::size_t i = 1; i <= count; ++i) {
        const float h = static_cast<float>(i);
        append(mesh, box({-h, -h, -h}, {h, h, h}));
    }
    return mesh;
}

Mesh repeated_triangle(std::size_t copies) {
    Mesh mesh;
    for (std::size_t i = 0; i < copies; ++i)
        mesh.add_triangle({-1, -1, 0.25f}, {1, -1, 0.5f}, {0, 1, 0.75f});
    return mesh;
}

std::vector<Sphere> sphere_grid(std::uint32_t side, float radius) {
    std::vector<Sphere> spheres;
    for (std::uint32_t z = 0; z < side; ++z)
        for (std::uint32_t y = 0; y < side; ++y)
            for (std::uint32_t x = 0; x < side; ++x)
                spheres.push_back(
                    {{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)},
                     radius});
    return spheres;
}

TestGeometry mixed_scene(std::uint64_t seed) {
    Random random(seed);
    TestGeometry scene;
    scene.add(triangle_soup(random, 400, 0.2f));
    scene.add(needles(random, 100, 1e-3f));
    scene.add(closed_sphere({0.3f, -0.2f, 0.1f}, 0.5f, 12));
    scene.add(box({-0.7f, -0.6f, -0.5f}, {-0.3f, 0.2f, 0.1f}));
    for (int i = 0; i < 60; ++i) {
        const Vec3 center = random.point(-1, 1);
        scene.add(Sphere{center, random.uniform(0.02f, 0.2f)});
    }
    return scene;
}

std::vector<Edge> shared_edges(const Mesh& mesh) {
    std::vector<Edge> edges;
    for (const auto& [edge, uses] : edge_uses(mesh))
        if (uses > 1)
            edges.push_back({edge.first, edge.second});
    return edges;
}

std::vector<std::uint32_t> inner_vertices(const Mesh& mesh) {
    std::vector<bool> inner(mesh.positions.size(), true);
    for (const auto& [edge, uses] : edge_uses(mesh))
        if (uses == 1)
            inner[edge.first] = inner[edge.second] = false;
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t i = 0; i < inner.size(); ++i)
        if (inner[i])
            vertices.push_back(i);
    return vertices;
}

} // namespace plumb::test
