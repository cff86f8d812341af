/// \file  The teapot in a stadium: detail at two very different scales.
#include "tools/bench_src/generate.h"
#include "tools/bench_src/sweep.h"

#include "renderer/sampling/warp.h"

#include <algorithm>

namespace plumb::bench {
namespace {

float fraction(std::uint32_t i, std::uint32_t n) {
    return static_cast<float>(i) / static_cast<float>(n);
}

/// Tiers of seats around an oval of 100 x 70, and the pitch: 3 m tall people would be at home.
void add_stadium(BenchMesh& mesh, double detail) {
    const std::uint32_t tiers = scaled_count(40, detail, 3);
    const std::uint32_t columns = scaled_count(192, detail, 8);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t row = 0; row < 2 * tiers; ++row) {
        const float out = 1 + 0.6f * fraction((row + 1) / 2, tiers);
        const float height = 30 * fraction(row / 2, tiers);
        for (std::uint32_t i = 0; i < columns; ++i) {
            const Vec2 p = polar(out, fraction(i, columns));
            mesh.add_vertex({100 * p.x, height, 70 * p.y});
        }
    }
    mesh.add_grid(first, 2 * tiers, columns, true);
    mesh.add_quad({-100, 0, -70}, {-100, 0, 70}, {100, 0, 70}, {100, 0, -70});
}

void add_body(BenchMesh& mesh, double detail) {
    const std::uint32_t rows = scaled_count(48, detail, 6), columns = scaled_count(96, detail, 8);
    std::vector<Vec2> profile;
    for (std::uint32_t i = 0; i < rows; ++i) {
        const float s = fraction(i, rows - 1);
        const Vec2 round = polar(1, 0.5f * s - 0.25f); // from bottom to top of a circle
        profile.push_back({0.12f + 0.1f * round.x - 0.03f * s, 0.11f * (1 + round.y)});
    }
    add_lathe(mesh, {}, profile, columns);
    profile.clear();
    for (std::uint32_t i = 0; i < rows / 2; ++i) { // lid and knob
        const float s = fraction(i, rows / 2 - 1);
        const float knob = 0.02f * max(0.0f, sincos_turns(max(0.0f, s - 0.6f)).sin);
        profile.push_back({0.09f * (1 - s) + knob, 0.22f + 0.05f * s * (2 - s)});
    }
    add_lathe(mesh, {}, profile, columns);
}

void add_handle_and_spout(BenchMesh& mesh, double detail) {
    const std::uint32_t rows = scaled_count(64, detail, 8), columns = scaled_count(20, detail, 5);
    std::vector<Vec3> handle, spout;
    std::vector<float> handle_radii, spout_radii;
    for (std::uint32_t i = 0; i < rows; ++i) {
        const float s = fraction(i, rows - 1);
        const Vec2 bow = polar(0.09f, 0.25f + 0.5f * s);
        handle.push_back({bow.x - 0.17f, 0.12f + 0.8f * bow.y, 0});
        handle_radii.push_back(0.012f);
        spout.push_back({0.18f + 0.16f * s, 0.07f + 0.15f * s * s * (3 - 2 * s), 0});
        spout_radii.push_back(0.045f - 0.028f * s);
    }
    add_tube(mesh, handle, handle_radii, columns);
    add_tube(mesh, spout, spout_radii, columns);
}

} // namespace

BenchMesh teapot(double detail) {
    BenchMesh mesh;
    add_body(mesh, detail);
    add_handle_and_spout(mesh, detail);
    add_stadium(mesh, detail);
    mesh.view = {{0.25f, 0.32f, 0.7f}, {0, 0.13f, 0}, {0, 1, 0}, 50, {0.8f, 1.4f, 0.9f}, 0.05f};
    return mesh;
}

} // namespace plumb::bench
