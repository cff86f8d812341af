/// \file  Runs axes: every stress of every axis, on several threads, the same numbers for any.
#pragma once

#include "tools/stability_src/axis.h"

#include <span>

namespace plumb::stability {

struct SweepOptions {
    bool quick = false; ///< fewer trials
    int threads = 1;    ///< 0: all cores
    std::uint64_t seed = 1;
};

/// An axis with what came of it: outcomes[stress][method].
struct AxisResult {
    Axis axis; ///< its stresses are those that ran
    std::vector<std::vector<Outcome>> outcomes;
};

/// A method that does not hold its limit, where it is worst.
struct Violation {
    std::size_t method, stress; ///< indices
};

/// Called from one thread at a time: how many of all steps are done, and which was the last.
using OnStep = std::function<void(std::size_t done, std::size_t all, const Axis& axis)>;

[[nodiscard]] std::vector<AxisResult> sweep(std::span<const Axis> axes, const SweepOptions& options,
                                            const OnStep& on_step = {});

/// At most one for each method.
[[nodiscard]] std::vector<Violation> violations(const AxisResult& result);

} // namespace plumb::stability
