/// \file  The five kinds of rays that every mesh is traced with.
#pragma once

#include "accel/intersector.h"
#include "tools/bench_src/bench_mesh.h"

#include <array>
#include <string_view>

namespace plumb::bench {

enum class RayKind : std::uint8_t { primary, shadow, diffuse, later, random };

inline constexpr std::array<RayKind, 5> ray_kinds{
    RayKind::primary, RayKind::shadow, RayKind::diffuse, RayKind::later, RayKind::random};
[[nodiscard]] std::string_view name_of(RayKind kind);
[[nodiscard]] std::string_view description_of(RayKind kind);

struct RaySet {
    RayKind kind;
    std::vector<Ray> rays; ///< all valid; may be empty where nothing is hit

    /// Traced by occluded(); the others by closest().
    [[nodiscard]] bool any_hit() const { return kind == RayKind::shadow; }
    /// Neighbours run alike: Embree's packets get the coherent flag.
    [[nodiscard]] bool coherent() const {
        return kind == RayKind::primary || kind == RayKind::shadow;
    }
};

/// - primary: a pinhole image of 1024 x 1024 pixel centres, in tiles of 16 x 16 pixels from left to
///   right and top to bottom, in each tile blocks of 4 x 4, so that 16 neighbours are one block.
///   Where the mesh asks for fewer rays, some of the tiles, evenly spread.
/// - shadow: from each primary hit to a random point of the light, same order, without the misses.
/// - diffuse: a cosine-distributed direction at primary hits, in order.
/// - later: the same once more from the hits of diffuse rays, shuffled.
/// - random: segments between two uniform points of the mesh's box.
///
/// The sets depend on the mesh alone: `guide` finds the hits, and must give the bits of naive with
/// the watertight test over this mesh as its only geometry.
[[nodiscard]] std::array<RaySet, ray_kinds.size()> make_ray_sets(const BenchMesh& mesh,
                                                                 const Intersector& guide);

} // namespace plumb::bench
