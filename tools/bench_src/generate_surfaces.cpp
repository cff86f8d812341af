/// \file  Closed surfaces: an octahedron's grid pushed onto a sphere, then displaced by noise.
#include "tools/bench_src/generate.h"
#include "tools/bench_src/noise.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace plumb::bench {
namespace {

/// Vertices in ring `ring` of 0 .. 2n between the poles.
std::uint32_t ring_size(std::uint32_t ring, std::uint32_t n) {
    const std::uint32_t k = std::min(ring, 2 * n - ring);
    return k == 0 ? 1 : 4 * k;
}

/// Point i of ring `ring` of the octahedron |x| + |y| + |z| = n.
Vec3 octahedron_point(std::uint32_t ring, std::uint32_t i, std::uint32_t n) {
    const std::uint32_t k = std::min(ring, 2 * n - ring);
    const float y = static_cast<float>(n) - static_cast<float>(ring);
    if (k == 0)
        return {0, y, 0};
    const auto a = static_cast<float>(i % k), b = static_cast<float>(k - i % k);
    switch (i / k) {
    case 0: return {b, y, -a};
    case 1: return {-a, y, -b};
    case 2: return {-b, y, a};
    default: return {a, y, b};
    }
}

/// The triangles between a ring of 4k vertices and one of 4(k+1) on the side of the equator; `flip`
/// where the larger ring lies above.
void join_rings(BenchMesh& mesh, std::uint32_t small, std::uint32_t large, std::uint32_t k,
                bool flip) {
    const std::uint32_t small_size = std::max(1u, 4 * k), large_size = 4 * (k + 1);
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        flip ? mesh.add_triangle(a, c, b) : mesh.add_triangle(a, b, c);
    };
    for (std::uint32_t side = 0; side < 4; ++side)
        for (std::uint32_t j = 0; j <= k; ++j) {
            const std::uint32_t s = small + (side * k + j) % small_size;
            const std::uint32_t l = large + side * (k + 1) + j;
            const std::uint32_t l_next = large + (side * (k + 1) + j + 1) % large_size;
            add(s, l, l_next);
            if (j < k)
                add(s, l_next, small + (side * k + j + 1) % small_size);
        }
}

/// Closed surface of 8 n^2 triangles, counter-clockwise seen from outside: unit directions times
/// radius(direction).
BenchMesh star_shaped(std::uint32_t n, const std::function<float(Vec3)>& radius) {
    BenchMesh mesh;
    mesh.positions.reserve(4 * std::size_t{n} * n + 2);
    mesh.triangles.reserve(8 * std::size_t{n} * n);
    std::vector<std::uint32_t> first;
    for (std::uint32_t ring = 0; ring <= 2 * n; ++ring) {
        first.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        for (std::uint32_t i = 0; i < ring_size(ring, n); ++i) {
            const Vec3 direction = normalize(octahedron_point(ring, i, n));
            mesh.add_vertex(direction * radius(direction));
        }
    }
    for (std::uint32_t k = 0; k < n; ++k) {
        join_rings(mesh, first[k], first[k + 1], k, false);
        join_rings(mesh, first[2 * n - k], first[2 * n - k - 1], k, true);
    }
    return mesh;
}

std::uint32_t scaled(std::uint32_t n, double detail) {
    return std::max(4u, static_cast<std::uint32_t>(n * std::sqrt(detail)));
}

} // namespace

BenchMesh terrain(double detail) {
    BenchMesh mesh = star_shaped(scaled(806, detail), [](Vec3 d) {
        const float ridges = 1 - std::fabs(gradient_noise(d * 6.0f, 11));
        return 1 + 0.06f * ridges * ridges + 0.05f * fractal_noise(d * 4.0f, 10, 0.5f, 23);
    });
    // Low over the mountains, towards the horizon.
    mesh.view = {{0.2f, 1.28f, 0.55f}, {0, 0.85f, -0.35f}, {0, 1, 0}, 60, {1.6f, 2.0f, 0.4f}, 0.1f};
    return mesh;
}

BenchMesh blob(double detail) {
    BenchMesh mesh = star_shaped(scaled(93, detail), [](Vec3 d) {
        return 1 + 0.45f * gradient_noise(d * 1.3f, 5) +
               0.05f * fractal_noise(d * 4.0f, 2, 0.4f, 7);
    });
    mesh.view = {{1.6f, 1.1f, 2.1f}, {0, 0, 0}, {0, 1, 0}, 52, {2, 3, 1}, 0.2f};
    return mesh;
}

BenchMesh scan(double detail) {
    BenchMesh mesh = star_shaped(scaled(447, detail), [](Vec3 d) {
        return 1 + 0.4f * fractal_noise(d * 1.5f, 4, 0.45f, 31) +
               0.004f * fractal_noise(d * 90.0f, 2, 0.6f, 37);
    });
    mesh.view = {{-1.7f, 0.9f, 2.0f}, {0, 0, 0}, {0, 1, 0}, 52, {1, 3, 3}, 0.2f};
    return mesh;
}

} // namespace plumb::bench
