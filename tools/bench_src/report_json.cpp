/// \file  The results for programs.
#include "tools/bench_src/report.h"

#include <cmath>
#include <fmt/format.h>
#include <string_view>

namespace plumb::bench {
namespace {

std::string text(std::string_view value) {
    std::string out = "\"";
    for (const char c : value) {
        if (c == '"' || c == '\\')
            out += fmt::format("\\{}", c);
        else if (static_cast<unsigned char>(c) < 0x20)
            out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        else
            out += c;
    }
    return out + "\"";
}

std::string number(double value) {
    return std::isfinite(value) ? fmt::format("{:.6g}", value) : "null";
}
std::string number(const std::optional<double>& value) { return value ? number(*value) : "null"; }

/// Elements joined by commas within brackets, each on a line of its own where `indent` is not
/// empty.
template <class Range, class F>
std::string array(const Range& range, F&& element, std::string_view indent = {}) {
    std::string out = "[";
    for (const auto& item : range) {
        if (out.size() > 1)
            out += indent.empty() ? ", " : ",";
        if (!indent.empty())
            out += "\n" + std::string(indent);
        out += element(item);
    }
    return out + "]";
}

std::string numbers(const std::vector<double>& values, double scale = 1) {
    return array(values, [scale](double v) { return number(scale * v); });
}

std::string build_json(const MeshResult& mesh, const BuildResult& build) {
    return fmt::format(
        "{{\"structure\": {}, \"build_ms\": {}, \"median_ms\": {}, \"mtri_per_s\": {}, "
        "\"bytes_per_triangle\": {}, \"sah_cost\": {}, \"depth\": {}, \"nodes\": {}, "
        "\"leaves\": {}}}",
        text(build.structure), numbers(build.build_s, 1e3), number(1e3 * build.median_s()),
        number(mesh.mtriangles_s(build)), number(mesh.bytes_per_triangle(build)),
        number(build.stats.sah_cost), build.stats.depth, build.stats.node_count,
        build.stats.leaf_count);
}

std::string entry_json(const Cell& cell, const Entry& e) {
    const auto per_ray = [&cell](std::uint64_t count) {
        return number(static_cast<double>(count) / static_cast<double>(cell.rays));
    };
    const auto to_packet = e.wide ? ratio_of(e.median(), cell.best_packet()) : std::nullopt;
    return fmt::format(
        "{{\"config\": {}, \"median_mrays_per_s\": {}, \"mrays_per_s\": {}, \"to_default\": {}, "
        "\"to_robust\": {}, \"to_packet\": {}, \"nodes_per_ray\": {}, \"leaves_per_ray\": {}, "
        "\"triangles_per_ray\": {}, \"wrong\": {}}}",
        text(e.config), number(e.median()), numbers(e.mrays_s),
        number(ratio_of(e.median(), cell.best_default())),
        number(ratio_of(e.median(), cell.best_robust())), number(to_packet),
        per_ray(e.counts.nodes), per_ray(e.counts.leaves), per_ray(e.counts.triangles), e.wrong);
}

std::string cell_json(const Cell& cell) {
    return fmt::format(
        "{{\"rays\": {}, \"any_hit\": {}, \"count\": {}, \"hits\": {}, \"entries\": {}}}",
        text(name_of(cell.kind)), cell.kind == RayKind::shadow, cell.rays, cell.hits,
        array(
            cell.entries, [&cell](const Entry& e) { return entry_json(cell, e); }, "        "));
}

std::string mesh_json(const MeshResult& mesh) {
    return fmt::format(
        "{{\"name\": {}, \"triangles\": {}, \"hash\": \"{:016x}\",\n"
        "     \"builds\": {},\n     \"cells\": {}}}",
        text(mesh.name), mesh.triangles, mesh.hash,
        array(
            mesh.builds, [&mesh](const BuildResult& b) { return build_json(mesh, b); }, "      "),
        array(mesh.cells, cell_json, "      "));
}

std::string ratio_json(const std::optional<Ratio>& ratio) {
    if (!ratio)
        return "null";
    return fmt::format(
        "{{\"geometric_mean\": {}, \"least\": {}, \"least_mesh\": {}, \"cells\": {}}}",
        number(ratio->geometric_mean), number(ratio->least), text(ratio->least_mesh), ratio->cells);
}

std::string row_json(const SummaryRow& row) {
    return fmt::format("{{\"config\": {}, \"rays\": {}, \"to_default\": {}, \"to_robust\": {}, "
                       "\"to_packet\": {}}}",
                       text(row.config), text(name_of(row.kind)), ratio_json(row.to_default),
                       ratio_json(row.to_robust), ratio_json(row.to_packet));
}

} // namespace

std::string to_json(const RunInfo& info, const std::vector<MeshResult>& meshes) {
    std::string out = "{\n";
    const auto member = [&out](std::string_view key, const std::string& value) {
        out += fmt::format("  {}: {},\n", text(key), value);
    };
    member("version", text(PLUMB_VERSION));
    member("command_line", text(info.command_line));
    member("cpu", text(info.cpu));
    member("isas", array(info.isas, [](Isa isa) { return text(name_of(isa)); }));
    member("embree", text(info.embree));
    member("compiler", text(info.compiler));
    member("clock", text("CPU time; builds on several threads: wall time"));
    member("build_threads", std::to_string(info.threads));
    member("repetitions", std::to_string(info.repetitions));
    member("seconds", number(info.seconds));
    member("quick", info.quick ? "true" : "false");
    member("meshes", array(meshes, mesh_json, "    "));
    out += "  \"summary\": " + array(summary_of(meshes), row_json, "    ");
    return out + "\n}\n";
}

} // namespace plumb::bench
