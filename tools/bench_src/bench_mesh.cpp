#include "tools/bench_src/bench_mesh.h"

#include <bit>

namespace plumb::bench {

void BenchMesh::add_grid(std::uint32_t first, std::uint32_t rows, std::uint32_t columns,
                         bool closed) {
    const std::uint32_t cells = closed ? columns : columns - 1;
    for (std::uint32_t row = 0; row + 1 < rows; ++row)
        for (std::uint32_t column = 0; column < cells; ++column) {
            const std::uint32_t next = (column + 1) % columns;
            const std::uint32_t low = first + row * columns, high = low + columns;
            add_quad(low + column, low + next, high + next, high + column);
        }
}

std::uint64_t hash_of(const BenchMesh& mesh) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto add = [&hash](std::uint32_t bits) { hash = (hash ^ bits) * 0x100000001b3u; };
    for (const Vec3& p : mesh.positions)
        for (const float x : {p.x, p.y, p.z})
            add(std::bit_cast<std::uint32_t>(x));
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t index : {t.a, t.b, t.c})
            add(index);
    return hash;
}

Bounds bounds_of(const BenchMesh& mesh) {
    Bounds bounds;
    for (const Vec3& p : mesh.positions)
        bounds.extend(p);
    return bounds;
}

} // namespace plumb::bench
