/// \file  Rooms: the Cornell box and a colonnade.
#include "tools/bench_src/generate.h"
#include "tools/bench_src/sweep.h"

#include "renderer/sampling/warp.h"

#include <algorithm>
#include <array>

namespace plumb::bench {
namespace {

float fraction(std::uint32_t i, std::uint32_t n) {
    return static_cast<float>(i) / static_cast<float>(n);
}

/// A block on the floor, turned around the vertical axis by `turns`.
void add_block(BenchMesh& mesh, Vec3 foot, float half_width, float height, float turns) {
    std::array<Vec3, 4> low{}, high{};
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2 p = polar(half_width * 1.41421356f, turns + 0.25f * static_cast<float>(i));
        low[i] = foot + Vec3{p.x, 0, p.y};
        high[i] = low[i] + Vec3{0, height, 0};
    }
    for (std::size_t i = 0; i < 4; ++i)
        mesh.add_quad(low[i], high[i], high[(i + 1) % 4], low[(i + 1) % 4]);
    mesh.add_quad(high[0], high[3], high[2], high[1]);
    mesh.add_quad(low[0], low[1], low[2], low[3]);
}

// The hall: 16 bays of 4 m along z, a nave 8 m wide, columns 6 m tall.
constexpr std::uint32_t bays = 16;
constexpr float bay = 4, hall_length = bay * bays, half_nave = 4, column_top = 6;

void add_floor(BenchMesh& mesh, double detail) {
    const std::uint32_t across = scaled_count(40, detail, 4), along = scaled_count(160, detail, 8);
    const float dx = 24 / static_cast<float>(across), dz = hall_length / static_cast<float>(along);
    for (std::uint32_t i = 0; i < across; ++i)
        for (std::uint32_t k = 0; k < along; ++k) { // a tile with bevelled edges
            const Vec3 o{-12 + dx * static_cast<float>(i), 0, dz * static_cast<float>(k)};
            const float e = 0.04f * dx, h = 0.01f;
            const std::array<Vec3, 4> outer{o, o + Vec3{0, 0, dz}, o + Vec3{dx, 0, dz},
                                            o + Vec3{dx, 0, 0}};
            const std::array<Vec3, 4> inner{o + Vec3{e, h, e}, o + Vec3{e, h, dz - e},
                                            o + Vec3{dx - e, h, dz - e}, o + Vec3{dx - e, h, e}};
            mesh.add_quad(inner[0], inner[1], inner[2], inner[3]);
            for (std::size_t s = 0; s < 4; ++s)
                mesh.add_quad(outer[s], outer[(s + 1) % 4], inner[(s + 1) % 4], inner[s]);
        }
}

/// Fluted, swelling in the middle, with a base and a capital.
void add_column(BenchMesh& mesh, Vec3 foot, double detail) {
    const std::uint32_t rows = scaled_count(36, detail, 4), columns = scaled_count(72, detail, 8);
    std::vector<Vec2> shaft;
    for (std::uint32_t i = 0; i < rows; ++i) {
        const float s = fraction(i, rows - 1);
        shaft.push_back({0.42f - 0.1f * s * s, 0.3f + 5.2f * s});
    }
    add_lathe(mesh, foot, shaft, columns, 0.08f);
    constexpr std::array<Vec2, 5> capital{
        {{0.32f, 5.5f}, {0.36f, 5.55f}, {0.5f, 5.75f}, {0.55f, 5.85f}, {0.55f, 6}}};
    add_lathe(mesh, foot, capital, columns);
    add_box(mesh, foot + Vec3{-0.6f, 0, -0.6f}, foot + Vec3{0.6f, 0.3f, 0.6f});
    add_box(mesh, foot + Vec3{-0.6f, 6, -0.6f}, foot + Vec3{0.6f, 6.2f, 0.6f});
}

/// Half a ring from one column to the next, with a wall up to the vault.
void add_arch(BenchMesh& mesh, float x, float z, double detail) {
    const std::uint32_t steps = scaled_count(48, detail, 6);
    constexpr float thickness = 0.35f, rise = 1.6f, wall_top = 9;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t i = 0; i <= steps; ++i) {
        const Vec2 p = polar(rise, 0.5f * fraction(i, steps));
        const float y = column_top + 0.2f + p.y, along = z + 0.5f * bay + p.x * 0.5f * bay / rise;
        for (const Vec2 corner : {Vec2{-thickness, wall_top}, Vec2{-thickness, y},
                                  Vec2{thickness, y}, Vec2{thickness, wall_top}})
            mesh.add_vertex({x + corner.x, corner.y, along});
    }
    mesh.add_grid(first, steps + 1, 4, false);
}

/// A barrel vault with ribs over the nave, and the flat roofs of the aisles.
void add_ceiling(BenchMesh& mesh, double detail) {
    const std::uint32_t along = scaled_count(256, detail, 16), across = scaled_count(96, detail, 8);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t k = 0; k <= along; ++k) {
        const float z = hall_length * fraction(k, along), in_bay = z / bay - std::floor(z / bay);
        const float rib = in_bay < 0.1f || in_bay > 0.9f ? 0.25f : 0;
        for (std::uint32_t i = 0; i <= across; ++i) {
            const Vec2 p = polar(half_nave - rib, 0.5f * fraction(i, across));
            mesh.add_vertex({p.x, 9 + p.y, z});
        }
    }
    mesh.add_grid(first, along + 1, across + 1, false);
    for (const float side : {-1.0f, 1.0f})
        mesh.add_quad({side * half_nave, 9, 0}, {side * 12, 8, 0}, {side * 12, 8, hall_length},
                      {side * half_nave, 9, hall_length});
}

/// Outer walls, one with windows' niches a bay, and the ends.
void add_walls(BenchMesh& mesh) {
    for (const float side : {-1.0f, 1.0f}) {
        mesh.add_quad({side * 12, 0, 0}, {side * 12, 8, 0}, {side * 12, 8, hall_length},
                      {side * 12, 0, hall_length});
        for (std::uint32_t k = 0; k < bays; ++k) {
            const float z = bay * static_cast<float>(k);
            add_box(mesh, {side * 11.8f - 0.15f, 0, z + 0.5f}, {side * 11.8f + 0.15f, 7, z + 1.2f});
            add_box(mesh, {side * 11.6f - 0.2f, 2, z + 1.8f},
                    {side * 11.6f + 0.2f, 2.2f, z + 3.4f});
        }
    }
    for (const float z : {0.0f, hall_length})
        mesh.add_quad({-12, 0, z}, {12, 0, z}, {12, 13, z}, {-12, 13, z});
}

/// Steps at the far end between balustrades.
void add_stairs(BenchMesh& mesh, double detail) {
    constexpr std::uint32_t steps = 14;
    for (std::uint32_t i = 0; i < steps; ++i) {
        const float z = 50 + 0.4f * static_cast<float>(i), y = 0.17f * static_cast<float>(i);
        add_box(mesh, {-3, 0, z}, {3, y + 0.17f, z + 0.42f});
    }
    const std::uint32_t rows = scaled_count(24, detail, 4), columns = scaled_count(20, detail, 5);
    std::vector<Vec2> profile;
    for (std::uint32_t i = 0; i < rows; ++i) {
        const float s = fraction(i, rows - 1);
        profile.push_back({0.05f + 0.05f * sincos_turns(s).sin * (1 - s), 0.9f * s});
    }
    for (const float x : {-3.0f, 3.0f})
        for (std::uint32_t i = 0; i < 2 * steps; ++i)
            add_lathe(mesh, {x, 0.085f * static_cast<float>(i), 50 + 0.2f * static_cast<float>(i)},
                      profile, columns);
}

} // namespace

BenchMesh cornell(double /*detail*/) {
    BenchMesh mesh;
    mesh.add_quad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1});
    mesh.add_quad({-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1});
    mesh.add_quad({-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1});
    mesh.add_quad({-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1}, {-1, 0, 1});
    mesh.add_quad({1, 0, -1}, {1, 0, 1}, {1, 2, 1}, {1, 2, -1});
    mesh.add_quad({-0.24f, 1.98f, -0.2f}, {0.24f, 1.98f, -0.2f}, {0.24f, 1.98f, 0.2f},
                  {-0.24f, 1.98f, 0.2f});
    add_block(mesh, {-0.33f, 0, -0.3f}, 0.3f, 1.2f, 0.175f);
    add_block(mesh, {0.35f, 0, 0.35f}, 0.3f, 0.6f, 0.08f);
    mesh.view = {{0, 1, 3.9f}, {0, 1, 0}, {0, 1, 0}, 38, {0, 1.9f, 0}, 0.07f};
    return mesh;
}

BenchMesh hall(double detail) {
    BenchMesh mesh;
    add_floor(mesh, detail);
    for (const float x : {-half_nave, half_nave})
        for (std::uint32_t k = 0; k <= bays; ++k) {
            add_column(mesh, {x, 0.01f, bay * static_cast<float>(k)}, detail);
            if (k < bays)
                add_arch(mesh, x, bay * static_cast<float>(k), detail);
        }
    add_ceiling(mesh, detail);
    add_walls(mesh);
    add_stairs(mesh, detail);
    mesh.view = {{-1.4f, 1.7f, 3}, {1.5f, 3, 30}, {0, 1, 0}, 75, {1, 8, 24}, 0.4f};
    return mesh;
}

} // namespace plumb::bench
