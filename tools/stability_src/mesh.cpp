#include "tools/stability_src/mesh.h"

#include <map>
#include <utility>

namespace plumb::stability {

void Mesh::connect() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
    around.assign(positions.size(), {});
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const Triangle t = triangles[i];
        for (const auto& [p, q] : {std::pair{t.a, t.b}, std::pair{t.b, t.c}, std::pair{t.c, t.a}})
            ++count[std::minmax(p, q)];
        for (const std::uint32_t vertex : {t.a, t.b, t.c})
            around[vertex].push_back(i);
    }
    std::vector<bool> inner(positions.size(), true);
    for (const auto& [edge, sides] : count)
        if (sides >= 2)
            edges.push_back({edge.first, edge.second});
        else
            inner[edge.first] = inner[edge.second] = false;
    for (std::uint32_t i = 0; i < positions.size(); ++i)
        if (inner[i])
            vertices.push_back(i);
}

Mesh closed_sphere(std::uint32_t rings, const std::function<Point(Point)>& place) {
    Mesh mesh;
    const std::uint32_t sides = 2 * rings;
    const auto add = [&](double theta, double phi) {
        const double r = std::sin(theta);
        const Point p = place({r * std::cos(phi), r * std::sin(phi), std::cos(theta)});
        mesh.positions.push_back(
            {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    };
    add(0, 0);
    for (std::uint32_t ring = 1; ring < rings; ++ring)
        for (std::uint32_t side = 0; side < sides; ++side)
            add(pi_double * ring / rings, 2 * pi_double * side / sides);
    add(pi_double, 0);
    const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    const auto at = [&](std::uint32_t ring, std::uint32_t side) {
        return 1 + (ring - 1) * sides + side % sides;
    };
    for (std::uint32_t side = 0; side < sides; ++side) {
        mesh.triangles.push_back({0, at(1, side), at(1, side + 1)});
        for (std::uint32_t ring = 1; ring + 1 < rings; ++ring) {
            const std::uint32_t a = at(ring, side), b = at(ring, side + 1);
            const std::uint32_t c = at(ring + 1, side), d = at(ring + 1, side + 1);
            mesh.triangles.push_back({a, c, d});
            mesh.triangles.push_back({a, d, b});
        }
        mesh.triangles.push_back({at(rings - 1, side), last, at(rings - 1, side + 1)});
    }
    mesh.connect();
    return mesh;
}

Mesh plane(float size, std::uint32_t cells) {
    Mesh mesh;
    const float step = size / static_cast<float>(cells), low = -0.5f * size;
    for (std::uint32_t y = 0; y <= cells; ++y)
        for (std::uint32_t x = 0; x <= cells; ++x)
            mesh.positions.push_back(
                {low + step * static_cast<float>(x), low + step * static_cast<float>(y), 0});
    for (std::uint32_t y = 0; y < cells; ++y)
        for (std::uint32_t x = 0; x < cells; ++x) {
            const std::uint32_t a = y * (cells + 1) + x, b = a + 1, c = a + cells + 1, d = c + 1;
            mesh.triangles.push_back({a, b, d});
            mesh.triangles.push_back({a, d, c});
        }
    mesh.connect();
    return mesh;
}

} // namespace plumb::stability
