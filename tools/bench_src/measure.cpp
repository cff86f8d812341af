#include "tools/bench_src/measure.h"

#include "tools/bench_src/check.h"
#include "tools/bench_src/structure.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <stdexcept>

namespace plumb::bench {
namespace {

constexpr std::size_t huge_mesh = 1'000'000;

/// A configuration with its structure and, in the current cell, its rays.
struct Contestant {
    const Config* config;
    const Structure* structure;
    Structure::Prepared prepared;
    std::uint64_t checksum = 0;
};

/// The structures of the configurations, each once, by name.
std::map<std::string, Structure> structures_of(const std::vector<Config>& configs,
                                               GeometryView view) {
    std::map<std::string, Structure> structures;
    for (const Config& config : configs)
        structures.try_emplace(config.structure.name, config.structure, view);
    return structures;
}

void build_all(std::map<std::string, Structure>& structures, int builds, Progress& progress) {
    for (int i = 0; i < builds; ++i)
        for (auto& [name, structure] : structures) {
            progress.detail(fmt::format("build {} of {}: {}", i + 1, builds, name));
            structure.build();
        }
}

/// Answers of naive: the yardstick of everyone with the same triangle test.
class References {
  public:
    explicit References(GeometryView view) : view_(view) {}
    [[nodiscard]] const Intersector& intersector(TriangleTest test) {
        auto& slot = intersectors_[test];
        if (!slot)
            slot = make_intersector(AccelKind::naive, view_, {.triangle_test = test});
        return *slot;
    }
    /// Hits, anonymous where the set is an any-hit one; kept until the next set.
    [[nodiscard]] std::span<const Hit> answers(const RaySet& rays, TriangleTest test) {
        if (rays_ != &rays)
            answers_.clear();
        rays_ = &rays;
        std::vector<Hit>& hits = answers_[test];
        if (hits.empty())
            for (const Ray& ray : rays.rays) {
                const Hit hit = intersector(test).closest(ray);
                hits.push_back(rays.any_hit() && hit.valid() ? Hit{0, 0, 0, 0, 0, invalid_id}
                                                             : hit);
            }
        return hits;
    }

  private:
    GeometryView view_;
    std::map<TriangleTest, std::unique_ptr<Intersector>> intersectors_;
    const RaySet* rays_ = nullptr;
    std::map<TriangleTest, std::vector<Hit>> answers_;
};

Entry checked_entry(Contestant& contestant, const RaySet& rays, References& references) {
    const Config& config = *contestant.config;
    Entry entry;
    entry.config = config.name;
    entry.embree = config.is_embree();
    entry.robust = config.structure.embree.robust;
    entry.wide = config.wide;
    std::vector<Hit> hits(rays.rays.size());
    contestant.checksum = contestant.structure->answers(contestant.prepared, hits);
    const TriangleTest test =
        entry.embree ? TriangleTest::watertight : config.structure.build.triangle_test;
    const std::span<const Hit> reference = references.answers(rays, test);
    entry.wrong = entry.embree ? far_apart(hits, reference) : different_bits(hits, reference);
    entry.counts = contestant.structure->count(rays);
    return entry;
}

/// Mrays/s of as many passes as take `seconds`.
double repetition(const Contestant& contestant, double seconds) {
    double elapsed_s = 0;
    std::size_t traced = 0;
    while (elapsed_s < seconds || traced == 0) {
        const Pass pass = contestant.structure->trace(contestant.prepared);
        if (pass.checksum != contestant.checksum)
            throw std::runtime_error(contestant.config->name +
                                     ": a timed pass gave other answers than the checked one");
        elapsed_s += pass.cpu_s;
        traced += contestant.prepared.rays->rays.size();
    }
    return 1e-6 * static_cast<double>(traced) / elapsed_s;
}

Cell measure_cell(const RaySet& rays, std::vector<Contestant>& contestants,
                  const MeasureOptions& options, References& references, Progress& progress) {
    Cell cell;
    cell.kind = rays.kind;
    cell.rays = rays.rays.size();
    for (Contestant& contestant : contestants) {
        progress.detail("checking " + contestant.config->name);
        contestant.prepared = contestant.structure->prepare(rays, contestant.config->wide);
        cell.entries.push_back(checked_entry(contestant, rays, references));
    }
    for (const Hit& hit : references.answers(rays, TriangleTest::watertight))
        cell.hits += hit.valid() ? 1u : 0u;
    for (int i = 0; i < options.repetitions; ++i)
        for (std::size_t c = 0; c < contestants.size(); ++c) {
            progress.detail(fmt::format("repetition {} of {}, {}", i + 1, options.repetitions,
                                        contestants[c].config->name));
            cell.entries[c].mrays_s.push_back(repetition(contestants[c], options.seconds));
        }
    return cell;
}

} // namespace

MeshResult measure(const BenchMesh& mesh, const MeasureOptions& options, Progress& progress) {
    MeshResult result{mesh.name, mesh.triangles.size(), hash_of(mesh), {}, {}};
    const MeshView mesh_view = mesh.mesh_view();
    const GeometryView view{{&mesh_view, 1}, {}};
    std::map<std::string, Structure> structures = structures_of(options.configs, view);
    progress.stage(fmt::format("{}: {} triangles, building", mesh.name, mesh.triangles.size()));
    build_all(structures, mesh.triangles.size() > huge_mesh ? 1 : options.builds, progress);
    for (const Config& config : options.configs) {
        const Structure& structure = structures.at(config.structure.name);
        if (std::none_of(result.builds.begin(), result.builds.end(),
                         [&](const auto& b) { return b.structure == config.structure.name; }))
            result.builds.push_back(
                {config.structure.name, structure.build_s(), structure.stats()});
    }
    progress.stage(mesh.name + ": making rays");
    References references(view);
    const auto ray_sets = make_ray_sets(mesh, *make_intersector(AccelKind::sah, view, {}));
    for (const RayKind kind : options.kinds)
        for (const RaySet& rays : ray_sets) {
            std::vector<Contestant> contestants;
            for (const Config& config : options.configs)
                contestants.push_back({&config, &structures.at(config.structure.name), {}, 0});
            if (rays.kind != kind || rays.rays.empty() || contestants.empty())
                continue;
            progress.stage(
                fmt::format("{}: {} {} rays", mesh.name, rays.rays.size(), name_of(kind)));
            result.cells.push_back(measure_cell(rays, contestants, options, references, progress));
            result.cells.back().mesh = mesh.name;
        }
    return result;
}

} // namespace plumb::bench
