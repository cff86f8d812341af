/// \file  The tables that a person reads.
#include "tools/bench_src/report.h"

#include <algorithm>
#include <fmt/format.h>

namespace plumb::bench {
namespace {

/// 1234567 as 1,234,567.
std::string grouped(std::uint64_t value) {
    std::string digits = std::to_string(value);
    for (std::size_t i = digits.size(); i > 3; i -= 3)
        digits.insert(i - 3, ",");
    return digits;
}

std::string ratio_text(std::optional<double> ratio) {
    return ratio ? fmt::format("{:.2f}", *ratio) : "-";
}

std::string per_ray(std::uint64_t count, const Cell& cell, const Entry& entry) {
    if (entry.counts.nodes + entry.counts.leaves + entry.counts.triangles == 0)
        return "-";
    return fmt::format("{:.2f}", static_cast<double>(count) / static_cast<double>(cell.rays));
}

/// Three significant digits or two decimals, whichever is more.
std::string rate(double mrays_s) {
    return mrays_s < 1 ? fmt::format("{:.4f}", mrays_s) : fmt::format("{:.2f}", mrays_s);
}

std::string builds_text(const MeshResult& mesh) {
    std::string out = fmt::format("  {:<31}{:>11}{:>10}{:>12}{:>10}{:>8}\n", "build", "ms",
                                  "Mtri/s", "bytes/tri", "SAH cost", "depth");
    for (const BuildResult& b : mesh.builds)
        out += fmt::format("  {:<31}{:>11.2f}{:>10.2f}{:>12.1f}{:>10}{:>8}\n", b.structure,
                           1e3 * b.median_s(), mesh.mtriangles_s(b), mesh.bytes_per_triangle(b),
                           b.stats.sah_cost > 0 ? fmt::format("{:.2f}", b.stats.sah_cost) : "-",
                           b.stats.depth > 0 ? std::to_string(b.stats.depth) : "-");
    return out;
}

std::string cell_text(const Cell& cell) {
    std::string out = fmt::format(
        "\n  {} ({}): {} rays, {:.1f} % hit\n", name_of(cell.kind), description_of(cell.kind),
        grouped(cell.rays), 100 * static_cast<double>(cell.hits) / static_cast<double>(cell.rays));
    out +=
        fmt::format("  {:<31}{:>8}{:>8}{:>8}{:>9}{:>8}{:>8}{:>8}{:>8}{:>7}\n", "Mrays/s", "median",
                    "min", "max", "/default", "/robust", "/packet", "nodes", "tris", "wrong");
    const double base_default = cell.best_default(), base_robust = cell.best_robust();
    for (const Entry& e : cell.entries) {
        const auto [low, high] = std::minmax_element(e.mrays_s.begin(), e.mrays_s.end());
        const auto to_packet = e.wide ? ratio_of(e.median(), cell.best_packet()) : std::nullopt;
        out += fmt::format(
            "  {:<31}{:>8}{:>8}{:>8}{:>9}{:>8}{:>8}{:>8}{:>8}{:>7}\n", e.config, rate(e.median()),
            rate(*low), rate(*high), ratio_text(ratio_of(e.median(), base_default)),
            ratio_text(ratio_of(e.median(), base_robust)), ratio_text(to_packet),
            per_ray(e.counts.nodes, cell, e), per_ray(e.counts.triangles, cell, e), e.wrong);
    }
    return out;
}

std::string ratio_columns(const std::optional<Ratio>& ratio) {
    return ratio ? fmt::format("{:>6.2f}{:>6.2f} {:<10.10}", ratio->geometric_mean, ratio->least,
                               ratio->least_mesh)
                 : fmt::format("{:>6}{:>6} {:<10}", "-", "-", "");
}

std::string without_trailing_spaces(std::string line) {
    line.erase(line.find_last_not_of(' ') + 1);
    return line;
}

} // namespace

std::string head_text(const RunInfo& info) {
    std::string isas;
    for (const Isa isa : info.isas)
        isas += " " + std::string(name_of(isa));
    return fmt::format("Plumbline {} and Embree {} on {} ({})\n"
                       "one thread, CPU time; medians of {} interleaved repetitions of at least "
                       "{:g} ms; builds on {}\n",
                       PLUMB_VERSION, info.embree, info.cpu, isas.substr(1), info.repetitions,
                       1e3 * info.seconds,
                       info.threads == 0   ? "all cores"
                       : info.threads == 1 ? "one thread"
                                           : fmt::format("{} threads", info.threads));
}

std::string mesh_text(const MeshResult& mesh) {
    std::string out = fmt::format("\n{}: {} triangles\n{}", mesh.name, grouped(mesh.triangles),
                                  builds_text(mesh));
    for (const Cell& cell : mesh.cells)
        out += cell_text(cell);
    return out;
}

std::string summary_text(const std::vector<SummaryRow>& summary) {
    const bool any = std::any_of(summary.begin(), summary.end(), [](const SummaryRow& row) {
        return row.to_default || row.to_robust || row.to_packet;
    });
    if (!any)
        return "";
    std::string out = "\nRatios to the fastest Embree of the same run: geometric mean over the "
                      "meshes, and the least with its mesh\n";
    out += fmt::format("  {:<38}   {:<20}   {:<20}   packets of 16\n", "", "default single rays",
                       "robust single rays");
    out += fmt::format("  {:<38}{:>6}{:>6} {:<10}{:>6}{:>6} {:<10}{:>6}{:>6}\n", "", "mean",
                       "least", "of", "mean", "least", "of", "mean", "least");
    for (const SummaryRow& row : summary)
        out += without_trailing_spaces(fmt::format("  {:<30}{:<8}{}{}{}", row.config,
                                                   name_of(row.kind), ratio_columns(row.to_default),
                                                   ratio_columns(row.to_robust),
                                                   ratio_columns(row.to_packet))) +
               "\n";
    return out;
}

} // namespace plumb::bench
