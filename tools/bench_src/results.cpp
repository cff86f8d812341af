#include "tools/bench_src/results.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace plumb::bench {
namespace {

template <class Counts> double best_of(const Cell& cell, Counts&& counts) {
    double best = 0;
    for (const Entry& entry : cell.entries)
        if (entry.embree && counts(entry))
            best = std::max(best, entry.median());
    return best;
}

/// Of `config` to the base of each cell of one kind.
template <class Base>
std::optional<Ratio> ratio_over(const std::vector<MeshResult>& meshes, const std::string& config,
                                RayKind kind, Base&& base) {
    Ratio ratio;
    double logarithms = 0;
    for (const MeshResult& mesh : meshes)
        for (const Cell& cell : mesh.cells)
            for (const Entry& entry : cell.entries) {
                if (cell.kind != kind || entry.config != config)
                    continue;
                const std::optional<double> r = ratio_of(entry.median(), base(cell));
                if (!r)
                    continue;
                logarithms += std::log(*r);
                if (ratio.cells++ == 0 || *r < ratio.least) {
                    ratio.least = *r;
                    ratio.least_mesh = mesh.name;
                }
            }
    if (ratio.cells == 0)
        return std::nullopt;
    ratio.geometric_mean = std::exp(logarithms / static_cast<double>(ratio.cells));
    return ratio;
}

} // namespace

double median_of(std::vector<double> values) {
    if (values.empty())
        return 0;
    std::sort(values.begin(), values.end());
    return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

std::optional<double> ratio_of(double value, double base) {
    return base > 0 ? std::optional(value / base) : std::nullopt;
}

double Entry::median() const { return median_of(mrays_s); }

double Cell::best_default() const {
    return best_of(*this, [](const Entry& e) { return !e.robust && !e.wide; });
}
double Cell::best_robust() const {
    return best_of(*this, [](const Entry& e) { return e.robust && !e.wide; });
}
double Cell::best_packet() const {
    return best_of(*this, [](const Entry& e) { return e.wide; });
}

double BuildResult::median_s() const { return median_of(build_s); }

double MeshResult::mtriangles_s(const BuildResult& build) const {
    return ratio_of(1e-6 * static_cast<double>(triangles), build.median_s()).value_or(0);
}
double MeshResult::bytes_per_triangle(const BuildResult& build) const {
    return static_cast<double>(build.stats.bytes) / static_cast<double>(triangles);
}

std::vector<SummaryRow> summary_of(const std::vector<MeshResult>& meshes) {
    std::vector<std::string> configs; // in the order of their first cell
    std::set<std::pair<std::string, RayKind>> ran;
    for (const MeshResult& mesh : meshes)
        for (const Cell& cell : mesh.cells)
            for (const Entry& entry : cell.entries) {
                if (entry.embree)
                    continue;
                if (std::find(configs.begin(), configs.end(), entry.config) == configs.end())
                    configs.push_back(entry.config);
                ran.emplace(entry.config, cell.kind);
            }
    std::vector<SummaryRow> rows;
    for (const std::string& config : configs)
        for (const RayKind kind : ray_kinds) {
            if (!ran.contains({config, kind}))
                continue;
            SummaryRow row{config, kind, {}, {}, {}};
            row.to_default = ratio_over(meshes, config, kind, std::mem_fn(&Cell::best_default));
            row.to_robust = ratio_over(meshes, config, kind, std::mem_fn(&Cell::best_robust));
            if (config.ends_with("/stream"))
                row.to_packet = ratio_over(meshes, config, kind, std::mem_fn(&Cell::best_packet));
            rows.push_back(row);
        }
    return rows;
}

} // namespace plumb::bench
