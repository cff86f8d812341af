/// \file  Subtrees of up to 64 primitives: every split position on three axes.
#pragma once

#include "accel/sah/primitive_ref.h"
#include "accel/sah/tree_piece.h"

namespace plumb {

inline constexpr std::size_t small_range_size = 64;

/// What a builder knows about the whole scene.
struct BuildContext {
    Float4 area_scale;            ///< see best_binned_split
    PrimitiveNumber first_sphere; ///< lower numbers are triangles
    float traversal_cost;         ///< see traversal_cost_of
};

/// Appends the subtree of 1 to small_range_size primitives whose root is an existing node of the
/// piece, at `depth`. The node's bounds are set already.
void build_small_range(const BuildContext& context, std::span<const PrimitiveRef> refs,
                       std::size_t node, int depth, TreePiece& piece);

/// Whether a subtree of `count` primitives at `depth` has to be halved from here on to stay within
/// sah_max_depth, a last split into triangles and spheres included.
[[nodiscard]] bool must_halve(std::size_t count, int depth);

} // namespace plumb
