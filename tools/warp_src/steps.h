/// \file  What the traversal of one ray does, step by step.
#pragma once

#include "cuda/device_tree.h"

#include <vector>

namespace plumb::warps {

enum class StepKind : std::uint8_t { node, triangle, sphere };

/// A node that is tested, or `count` primitives of a leaf one after the other.
struct Step {
    const std::byte* address;
    StepKind kind;
    std::uint32_t count;

    [[nodiscard]] bool is_node() const { return kind == StepKind::node; }
};

/// A ray and what is asked of it.
struct Question {
    Ray ray;
    bool any_hit = false;
};

/// Steps of the very traversal that kernels run, one tree or the other. Watertight triangles.
[[nodiscard]] std::vector<Step> steps_of(const TreeViews& trees, CudaTree tree,
                                         const Question& question);

} // namespace plumb::warps
