/// \file  What is timed: structures, and the ways to query them.
#pragma once

#include "accel/embree/embree_options.h"
#include "cuda/ray_tracer.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb::bench {

/// A structure to build. `accel` says which options count.
struct StructureConfig {
    std::string name; ///< such as sah/medium/avx512 or embree/high/robust
    AccelKind accel = AccelKind::sah;
    BuildOptions build;   ///< naive and sah
    EmbreeOptions embree; ///< embree
    /// Set: kernels of a GPU over this tree, on this side, in place of `accel`.
    std::optional<CudaTree> cuda;
    RaySide side = RaySide::device;
};

/// A structure and a way to query it: one line of the tables.
struct Config {
    std::string name; ///< the structure's, followed by /stream or /packet16 where `wide`
    StructureConfig structure;
    bool wide = false;       ///< closest(span), or Embree's packets
    bool by_default = false; ///< runs where nothing is selected

    [[nodiscard]] bool is_embree() const { return structure.accel == AccelKind::embree; }
};

/// Every configuration that this processor can run, builds on `threads` threads. `side`: those of
/// the GPU's kernels too.
[[nodiscard]] std::vector<Config> all_configs(int threads, std::optional<RaySide> side = {});

/// Whether `text` matches `pattern`, in which * stands for any characters.
[[nodiscard]] bool matches_glob(std::string_view pattern, std::string_view text);

/// Largest mesh on which naive runs unless it is asked for by name.
inline constexpr std::size_t naive_limit = 400'000;

} // namespace plumb::bench
