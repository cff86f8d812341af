/// \file  What tools/stability prints and writes.
#pragma once

#include "tools/stability_src/sweep.h"

namespace plumb::stability {

/// How and where the axes ran.
struct RunInfo {
    std::string command_line, cpu, embree, compiler;
    SweepOptions options;
};

/// Everything, for programs and for the page: see README.md for its members.
[[nodiscard]] std::string to_json(const RunInfo& info, std::span<const AxisResult> results);

/// A line for each axis: the default at its worst, its limit, the worst of the others.
[[nodiscard]] std::string table_text(std::span<const AxisResult> results);

/// A line for each method that does not hold its limit; empty if all do.
[[nodiscard]] std::string violations_text(std::span<const AxisResult> results);

} // namespace plumb::stability
