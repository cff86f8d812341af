/// \file  Long thin geometry: needles and hair.
#include "tools/bench_src/generate.h"
#include "tools/bench_src/noise.h"
#include "tools/bench_src/random.h"

#include "accel/math/frame.h"
#include "renderer/sampling/warp.h"

#include <algorithm>

namespace plumb::bench {
namespace {

Vec3 noise_vector(Vec3 p) {
    return {gradient_noise(p, 101), gradient_noise(p, 102), gradient_noise(p, 103)};
}

/// A ribbon that grows out of the unit sphere, falls and curls.
void add_strand(BenchMesh& mesh, Vec3 root, Vec3 side, std::uint32_t segments) {
    constexpr float length_total = 1.4f, width = 0.0025f;
    const float step = length_total / static_cast<float>(segments);
    Vec3 p = root, along = root;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t i = 0; i <= segments; ++i) {
        const float left = 1 - 0.9f * static_cast<float>(i) / static_cast<float>(segments);
        const Vec3 across = normalize(cross(along, side)) * (0.5f * width * left);
        mesh.add_vertex(p - across);
        mesh.add_vertex(p + across);
        along = normalize(along + Vec3{0, -2.6f * step, 0} + noise_vector(p * 2.5f) * 0.5f +
                          noise_vector(p * 9.0f) * 0.25f);
        p = p + along * step;
        if (const float distance = length(p); distance < 1.03f)
            p = p * (1.03f / distance); // the head
    }
    mesh.add_grid(first, segments + 1, 2, false);
}

} // namespace

BenchMesh needles(double detail) {
    BenchMesh mesh;
    Random random(60'000);
    const auto count = std::max<std::size_t>(1, static_cast<std::size_t>(60'000 * detail));
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 tail = random.point({-1, -1, -1}, {1, 1, 1});
        const Vec3 along = sample_uniform_sphere(random.square()).direction;
        const Vec3 across = Frame(along).to_world({0.004f, 0, 0});
        const std::uint32_t first = mesh.add_vertex(tail);
        mesh.add_vertex(tail + across);
        mesh.add_triangle(first, first + 1, mesh.add_vertex(tail + along * 1.5f));
    }
    mesh.view = {{2.2f, 1.6f, 2.6f}, {0, 0, 0}, {0, 1, 0}, 45, {3, 4, 1}, 0.3f};
    mesh.coherent_rays = std::size_t{1} << 14u;
    mesh.incoherent_rays = std::size_t{1} << 13u;
    return mesh;
}

BenchMesh hair(double detail) {
    BenchMesh mesh;
    Random random(840'000);
    const auto strands = std::max<std::size_t>(1, static_cast<std::size_t>(20'000 * detail));
    for (std::size_t i = 0; i < strands; ++i) {
        const Vec2 u = random.square();
        const Vec3 root = sample_uniform_sphere({0.65f * u.x, u.y}).direction; // z > -0.3: up
        const Vec3 side = sample_uniform_sphere(random.square()).direction;
        add_strand(mesh, Vec3{root.x, root.z, -root.y}, side, 21);
    }
    mesh.view = {{1.8f, 0.9f, 2.8f}, {0, -0.1f, 0}, {0, 1, 0}, 42, {2.5f, 4, 2}, 0.2f};
    mesh.coherent_rays = std::size_t{1} << 18u;
    mesh.incoherent_rays = std::size_t{1} << 16u;
    return mesh;
}

} // namespace plumb::bench
