#include "tools/bench_src/sweep.h"

#include "renderer/sampling/warp.h"

#include <algorithm>
#include <array>

namespace plumb::bench {
namespace {

float fraction(std::uint32_t i, std::uint32_t n) {
    return static_cast<float>(i) / static_cast<float>(n);
}

} // namespace

void add_box(BenchMesh& mesh, Vec3 lower, Vec3 upper) {
    std::array<std::uint32_t, 8> corner{}; // bit 0: x, bit 1: y, bit 2: z
    for (std::uint32_t i = 0; i < 8; ++i)
        corner[i] =
            mesh.add_vertex({(i & 1u) != 0 ? upper.x : lower.x, (i & 2u) != 0 ? upper.y : lower.y,
                             (i & 4u) != 0 ? upper.z : lower.z});
    constexpr std::uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& f : faces)
        mesh.add_quad(corner[f[0]], corner[f[1]], corner[f[2]], corner[f[3]]);
}

void add_lathe(BenchMesh& mesh, Vec3 base, std::span<const Vec2> profile, std::uint32_t columns,
               float flute) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec2& point : profile)
        for (std::uint32_t i = 0; i < columns; ++i) {
            const float turn = fraction(i, columns);
            const float groove = sincos_turns(24 * turn - std::floor(24 * turn)).cos;
            const Vec2 p = polar(point.x * (1 - flute * max(0.0f, groove)), turn);
            mesh.add_vertex(base + Vec3{p.x, point.y, p.y});
        }
    mesh.add_grid(first, static_cast<std::uint32_t>(profile.size()), columns, true);
}

void add_tube(BenchMesh& mesh, std::span<const Vec3> path, std::span<const float> radii,
              std::uint32_t columns) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::size_t i = 0; i < path.size(); ++i) {
        const Vec3 along =
            normalize(path[std::min(i + 1, path.size() - 1)] - path[i == 0 ? 0 : i - 1]);
        const Vec3 across = normalize(cross(along, Vec3{0, 0, 1}));
        for (std::uint32_t j = 0; j < columns; ++j) {
            const Vec2 p = polar(radii[i], fraction(j, columns));
            mesh.add_vertex(path[i] + across * p.x + Vec3{0, 0, p.y});
        }
    }
    mesh.add_grid(first, static_cast<std::uint32_t>(path.size()), columns, true);
}

std::uint32_t scaled_count(std::uint32_t count, double detail, std::uint32_t least) {
    return std::max(least, static_cast<std::uint32_t>(count * std::sqrt(detail)));
}

} // namespace plumb::bench
