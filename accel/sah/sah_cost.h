/// \file  Costs of the surface area heuristic.
#pragma once

#include <cstddef>

namespace plumb {

/// In units of one binary node visited. Leaves are tested as a block of eight lanes: a block costs
/// as such, and each triangle in it adds the chance that it passes the filter.
inline constexpr double traversal_cost = 1;   ///< C_t: a node
inline constexpr double block_cost = 1;       ///< C_i: a block of up to eight primitives
inline constexpr double primitive_cost = 0.1; ///< each primitive of a block

/// Cost of a node when a leaf is weighed against its halves. The few nodes of a small scene end up
/// in one or two wide ones, where another child costs next to nothing (Cornell box: rays 1.1 to
/// 1.4 x); in a large scene full leaves save memory and are as fast.
[[nodiscard]] constexpr float traversal_cost_of(std::size_t primitive_count) {
    return primitive_count <= 512 ? 0.2f : static_cast<float>(traversal_cost);
}

/// Cost of a leaf of `count` primitives, or a guess at the leaves that they will make; to be
/// multiplied by the area.
[[nodiscard]] constexpr double leaf_cost(std::size_t count) {
    const std::size_t blocks = (count + 7) / 8;
    return block_cost * static_cast<double>(blocks) + primitive_cost * static_cast<double>(count);
}

} // namespace plumb
