/// \file  One multiprocessor that traces rays: 32 lanes of a warp in step, warps in turns.
///
/// Exact: every lane's own steps, in its own order, from the very traversal that kernels run. The
/// model: lanes of a warp that are at the same place of the loop go through it together while the
/// others wait; resident warps take a turn of the loop each and share the L1. What is not in it:
/// which warp the schedulers prefer, queues of the memory, stacks in local memory, blocks that wait
/// for their last warp.
#pragma once

#include "tools/warp_src/gpu.h"
#include "tools/warp_src/l1_cache.h"
#include "tools/warp_src/steps.h"

#include <span>

namespace plumb::warps {

/// How lanes of the binary tree wait for one another.
enum class Loop : std::uint8_t {
    nodes_first, ///< lanes at leaves wait until all are at one: sah_traverse.h
    together     ///< a turn: those at nodes test theirs, then those that were at leaves
};

/// Registers of a thread, counted as the costs are (gpu.h).
inline constexpr std::uint32_t closest_registers = 77, any_hit_registers = 69,
                               persistent_registers = 95, megakernel_registers = 128;

struct Kernel {
    CudaTree tree = CudaTree::binary;
    std::uint32_t registers = closest_registers;
    Loop loop = Loop::nodes_first;
    /// Persistent threads: a warp takes new rays once no more than so many lanes are at work. 0: it
    /// ends when all have ended.
    std::uint32_t refill_at = 0;

    /// Warps on a multiprocessor at a time.
    [[nodiscard]] std::uint32_t resident(const Gpu& gpu) const;
};

/// What a warp does: lanes trace their rays at the same time, then the next ones.
struct Phase {
    std::vector<Question> lanes; ///< at most 32
    Cost besides{};              ///< of the warp, with as many lanes
};
using WarpWork = std::vector<Phase>;

/// Sums over all warps.
struct Totals {
    std::uint64_t rays = 0;
    double issued = 0, alu = 0; ///< instructions of warps
    double used = 0;            ///< instructions of lanes / 32
    double l1_clocks = 0;       ///< in which the L1 serves them
    double l2_bytes = 0;        ///< that missed the L1
    double memory_bytes = 0;    ///< of queues between kernels
    double latency = 0;         ///< clocks of all warps, each alone, / resident warps

    Totals& operator+=(const Totals& other);
    /// Share of the lanes that are at work in an instruction.
    [[nodiscard]] double lanes_used() const { return used / issued; }
};

/// Clocks of a multiprocessor, by what would hold it up if all else were free.
struct Clocks {
    double instructions, alu, l1, l2, memory, latency;

    Clocks(const Totals& totals, const Gpu& gpu);
    [[nodiscard]] double most() const;
    /// What holds it up.
    [[nodiscard]] const char* bound() const;
};

/// Clocks of the L1 for a load of `bytes` by each of `lanes` from so many lines of 128 bytes.
[[nodiscard]] double load_clocks(const Gpu& gpu, std::size_t lines, std::size_t lanes,
                                 std::uint32_t bytes);

class Multiprocessor {
  public:
    Multiprocessor(const Gpu& gpu, const Costs& costs, const TreeViews& trees,
                   const Kernel& kernel);

    /// Runs the warps to their end. What the L1 holds stays for the next call.
    void run(std::span<const WarpWork> warps);
    /// Persistent threads over a queue of rays, the first 32 to the first warp and so on.
    void run(std::span<const Question> queue);

    /// Instructions of a warp besides, with so many lanes.
    void besides(const Cost& cost, std::size_t lanes) { issue(cost, lanes); }

    [[nodiscard]] const Totals& totals() const { return totals_; }

  private:
    class Warp;
    void issue(const Cost& cost, std::size_t lanes);
    void load(std::span<const std::byte* const> from, std::uint32_t loads, std::uint32_t bytes,
              std::uint32_t stride);

    Gpu gpu_;
    Costs costs_;
    TreeViews trees_;
    Kernel kernel_;
    double resident_;
    L1Cache l1_;
    std::vector<std::uint64_t> sectors_; ///< of load()
    Totals totals_;
};

} // namespace plumb::warps
