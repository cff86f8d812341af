#include "tools/warp_src/report.h"

#include "tools/gpu_src/json.h"

#include <fmt/format.h>

namespace plumb::warps {
namespace {

using gpu::json_joined;
using gpu::json_member;
using gpu::json_number;
using gpu::json_text;

/// The numbers of a cell for each of its rays or paths.
struct Numbers {
    double lanes, instructions, alu, l1, l2_bytes, memory_bytes;
    Clocks clocks;

    Numbers(const Totals& totals, double items)
        : lanes(totals.lanes_used()), instructions(totals.issued / items), alu(totals.alu / items),
          l1(totals.l1_clocks / items), l2_bytes(totals.l2_bytes / items),
          memory_bytes(totals.memory_bytes / items), clocks(totals, Gpu{}) {}

    [[nodiscard]] std::string line() const {
        return fmt::format(
            "lanes {:3.0f} %  instructions {:6.1f} ({:6.1f} ALU)  L1 {:5.1f} clocks  "
            "L2 {:6.0f} bytes",
            100 * lanes, instructions, alu, l1, l2_bytes);
    }
    void to_json(std::vector<std::string>& members) const {
        members.push_back(json_member("lanes_used", json_number(lanes)));
        members.push_back(json_member("warp_instructions", json_number(instructions)));
        members.push_back(json_member("warp_instructions_alu", json_number(alu)));
        members.push_back(json_member("l1_clocks", json_number(l1)));
        members.push_back(json_member("l2_bytes", json_number(l2_bytes)));
        members.push_back(json_member("memory_bytes", json_number(memory_bytes)));
        members.push_back(json_member("bound", json_text(clocks.bound())));
    }
};

} // namespace

void Report::add(const std::string& mesh, const RayCell& cell) {
    const Numbers numbers(cell.totals, static_cast<double>(cell.totals.rays));
    fmt::print("{:10} {:8} {:6} {:21} {}  {:5.2f} G rays/s ({})\n", mesh, bench::name_of(cell.kind),
               plumb::name_of(cell.tree), name_of(cell.way), numbers.line(), 1e-9 * cell.rays_per_s,
               numbers.clocks.bound());
    std::vector<std::string> members{json_member("mesh", json_text(mesh)),
                                     json_member("rays", json_text(bench::name_of(cell.kind))),
                                     json_member("tree", json_text(plumb::name_of(cell.tree))),
                                     json_member("way", json_text(name_of(cell.way)))};
    numbers.to_json(members);
    members.push_back(json_member("g_rays_per_s", json_number(1e-9 * cell.rays_per_s)));
    rays_.push_back(json_joined(members, '{', '}'));
}

void Report::add(const std::string& scene, const PathCell& cell) {
    const Numbers numbers(cell.totals, cell.paths);
    fmt::print("{:19} {:6} {:21} {}  {:5.0f} M paths/s ({})\n", scene, plumb::name_of(cell.tree),
               name_of(cell.way), numbers.line(), 1e-6 * cell.paths_per_s, numbers.clocks.bound());
    std::vector<std::string> members{json_member("scene", json_text(scene)),
                                     json_member("tree", json_text(plumb::name_of(cell.tree))),
                                     json_member("way", json_text(name_of(cell.way)))};
    numbers.to_json(members);
    members.push_back(json_member("m_paths_per_s", json_number(1e-6 * cell.paths_per_s)));
    paths_.push_back(json_joined(members, '{', '}'));
}

std::string Report::json() const {
    return json_joined({json_member("version", json_text(PLUMB_VERSION)),
                        json_member("model", json_text("H100 SXM, counted, not measured")),
                        json_member("rays", json_joined(rays_, '[', ']', ",\n    ")),
                        json_member("paths", json_joined(paths_, '[', ']', ",\n    "))},
                       '{', '}', ",\n  ") +
           "\n";
}

} // namespace plumb::warps
