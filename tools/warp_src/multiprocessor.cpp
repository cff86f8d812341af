#include "tools/warp_src/multiprocessor.h"

#include "tools/warp_src/warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace plumb::warps {

std::uint32_t Kernel::resident(const Gpu& gpu) const {
    constexpr std::uint32_t unit = 256; // CUDA programming guide, occupancy: of a warp's registers
    const std::uint32_t of_warp = (registers * Gpu::lanes + unit - 1) / unit * unit;
    // Each of a block's warps goes to another of the four schedulers, which have a quarter each.
    const std::uint32_t blocks = gpu.registers / Gpu::warps_of_block / of_warp;
    return std::min(Gpu::most_warps, blocks * Gpu::warps_of_block);
}

Totals& Totals::operator+=(const Totals& other) {
    rays += other.rays;
    issued += other.issued;
    alu += other.alu;
    used += other.used;
    l1_clocks += other.l1_clocks;
    l2_bytes += other.l2_bytes;
    memory_bytes += other.memory_bytes;
    latency += other.latency;
    return *this;
}

Clocks::Clocks(const Totals& totals, const Gpu& gpu)
    : instructions(totals.issued / gpu.instructions), alu(totals.alu / gpu.alu_instructions),
      l1(totals.l1_clocks), l2(totals.l2_bytes / gpu.l2_bytes),
      memory(totals.memory_bytes / gpu.memory_bytes), latency(totals.latency) {}

double Clocks::most() const { return std::max({instructions, alu, l1, l2, memory, latency}); }

const char* Clocks::bound() const {
    const std::array<std::pair<double, const char*>, 6> all{{{instructions, "instructions"},
                                                             {alu, "ALU"},
                                                             {l1, "L1"},
                                                             {l2, "L2"},
                                                             {memory, "memory"},
                                                             {latency, "latency"}}};
    return std::ranges::max_element(all)->second;
}

double load_clocks(const Gpu& gpu, std::size_t lines, std::size_t lanes, std::uint32_t bytes) {
    const double tags = std::ceil(static_cast<double>(lines) / gpu.tag_lines);
    const double data = std::ceil(static_cast<double>(lanes) * bytes / gpu.data_bytes);
    return std::max(tags, data);
}

Multiprocessor::Multiprocessor(const Gpu& gpu, const Costs& costs, const TreeViews& trees,
                               const Kernel& kernel)
    : gpu_(gpu), costs_(costs), trees_(trees), kernel_(kernel), resident_(kernel.resident(gpu)),
      l1_(gpu.l1_size) {}

void Multiprocessor::run(std::span<const WarpWork> warps) {
    std::vector<std::unique_ptr<Warp>> at_work;
    while (!warps.empty() || !at_work.empty()) {
        while (!warps.empty() && at_work.size() < static_cast<std::size_t>(resident_)) {
            at_work.push_back(std::make_unique<Warp>(*this, warps.front()));
            warps = warps.subspan(1);
        }
        std::erase_if(at_work, [](const auto& warp) { return !warp->turn(); });
    }
}

void Multiprocessor::run(std::span<const Question> queue) {
    std::vector<std::unique_ptr<Warp>> at_work;
    for (int i = 0; i < static_cast<int>(resident_); ++i)
        at_work.push_back(std::make_unique<Warp>(*this, queue));
    while (!at_work.empty())
        std::erase_if(at_work, [](const auto& warp) { return !warp->turn(); });
}

void Multiprocessor::issue(const Cost& cost, std::size_t lanes) {
    totals_.issued += cost.all;
    totals_.alu += cost.alu;
    totals_.used += cost.all * static_cast<double>(lanes) / Gpu::lanes;
    totals_.latency += cost.all * gpu_.instruction_latency / resident_;
}

/// `loads` of `bytes` each by every lane, `stride` apart, the first at from[lane].
void Multiprocessor::load(std::span<const std::byte* const> from, std::uint32_t loads,
                          std::uint32_t bytes, std::uint32_t stride) {
    bool missed = false;
    for (std::uint32_t i = 0; i < loads; ++i) {
        sectors_.clear();
        for (const std::byte* address : from)
            sectors_.push_back((reinterpret_cast<std::uintptr_t>(address) + i * stride) /
                               L1Cache::sector_size);
        std::ranges::sort(sectors_);
        const auto [end, last] = std::ranges::unique(sectors_);
        sectors_.erase(end, last);
        std::uint32_t lines = 0;
        for (std::size_t k = 0; k < sectors_.size(); ++k) {
            lines += k == 0 || L1Cache::line_of(sectors_[k]) != L1Cache::line_of(sectors_[k - 1]);
            if (!l1_.touch(sectors_[k])) {
                missed = true;
                totals_.l2_bytes += L1Cache::sector_size;
            }
        }
        totals_.l1_clocks += load_clocks(gpu_, lines, from.size(), bytes);
    }
    totals_.latency += (missed ? gpu_.l2_latency : gpu_.l1_latency) / resident_;
}

} // namespace plumb::warps
