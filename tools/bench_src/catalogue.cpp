#include "tools/bench_src/catalogue.h"

#include "tools/bench_src/generate.h"

#include <algorithm>
#include <array>

namespace plumb::bench {
namespace {

constexpr std::array<CatalogueEntry, 8> entries{{
    {"cornell", "box room, two blocks: 36", cornell, 1},
    {"teapot", "fine teapot in a coarse stadium: 49 k", teapot, 0.05},
    {"needles", "long thin triangles at random: 60 k", needles, 0.02},
    {"bunny-like", "smooth closed surface: 69 k", blob, 0.05},
    {"hall", "colonnade with arches and stairs: 0.37 M", hall, 0.02},
    {"hair", "curled strands, thin ribbons: 0.84 M", hair, 0.01},
    {"scan-like", "rough closed surface: 1.6 M", scan, 0.005},
    {"terrain", "planet with mountains: 5.2 M", terrain, 0.002},
}};

} // namespace

std::span<const CatalogueEntry> catalogue() { return entries; }

BenchMesh generate(const CatalogueEntry& entry, bool quick) {
    BenchMesh mesh = entry.generate(quick ? entry.quick_detail : 1);
    mesh.name = entry.name;
    if (quick) {
        mesh.coherent_rays = std::min<std::size_t>(mesh.coherent_rays, std::size_t{1} << 13u);
        mesh.incoherent_rays = std::min<std::size_t>(mesh.incoherent_rays, std::size_t{1} << 12u);
    }
    return mesh;
}

} // namespace plumb::bench
