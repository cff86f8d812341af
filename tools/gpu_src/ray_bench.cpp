#include "tools/gpu_src/ray_bench.h"

#include "accel/sah/sah_intersector.h"
#include "tools/bench_src/catalogue.h"
#include "tools/bench_src/check.h"
#include "tools/gpu_src/json.h"

#include <algorithm>
#include <cstdio>

namespace plumb::gpu {
namespace {

constexpr std::size_t counted_rays = 1u << 14; ///< at least, of each kind, by the host

/// Hits of the CPU; of an any-hit set anonymous ones.
std::vector<Hit> answers(const Intersector& cpu, const bench::RaySet& set) {
    std::vector<Hit> hits(set.rays.size());
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (!set.any_hit())
            hits[i] = cpu.closest(set.rays[i]);
        else if (cpu.occluded(set.rays[i]))
            hits[i] = {0, 0, 0, 0, 0, invalid_id};
    return hits;
}

std::vector<Hit> fetched(const RayTracer& tracer, const bench::RaySet& set) {
    std::vector<Hit> hits(set.rays.size());
    if (!set.any_hit()) {
        tracer.fetch(hits);
        return hits;
    }
    std::vector<std::uint8_t> found(hits.size());
    tracer.fetch(found);
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (found[i] != 0) // neither 0 nor 1: was never written, equals no answer
            hits[i] = {0, 0, 0, found[i] - 1u, 0, invalid_id};
    return hits;
}

RayCell measure(RayTracer& tracer, const bench::RaySet& set, std::span<const Hit> expected,
                RayThreads threads, int repetitions) {
    RayCell cell;
    cell.kind = set.kind;
    cell.rays = set.rays.size();
    tracer.load(set.rays);
    std::vector<double> seconds;
    if (repetitions > 1)
        static_cast<void>(tracer.trace(set.any_hit(), threads)); // warms up
    for (int i = 0; i < repetitions; ++i)
        seconds.push_back(tracer.trace(set.any_hit(), threads));
    cell.wrong = bench::different_bits(fetched(tracer, set), expected);
    std::sort(seconds.begin(), seconds.end());
    cell.mrays_s = 1e-6 * static_cast<double>(cell.rays) / seconds[seconds.size() / 2];
    std::vector<Ray> counted; // evenly spread: the first ones are a corner of the image
    for (std::size_t i = 0; i < cell.rays; i += std::max<std::size_t>(cell.rays / counted_rays, 1))
        counted.push_back(set.rays[i]);
    const TraversalCounts counts = tracer.count(counted, set.any_hit());
    cell.nodes = static_cast<double>(counts.nodes) / static_cast<double>(counted.size());
    cell.primitives = static_cast<double>(counts.triangles) / static_cast<double>(counted.size());
    cell.kernels = tracer.kernels(set.any_hit(), threads);
    return cell;
}

void print(const RayResult& r, const RayCell& c) {
    std::printf("%-12s %8zu triangles %-7s %-10s %-8s %8zu rays %10.1f Mrays/s %7.2f nodes %7.2f "
                "triangles %6llu wrong\n",
                r.mesh.c_str(), r.triangles, name_of(r.tree).data(), name_of(r.threads).data(),
                bench::name_of(c.kind).data(), c.rays, c.mrays_s, c.nodes, c.primitives,
                static_cast<unsigned long long>(c.wrong));
    std::fflush(stdout);
}

} // namespace

void bench_rays(const Options& options, std::vector<RayResult>& results) {
    for (const bench::CatalogueEntry& entry : bench::catalogue()) {
        if (!entry.name.starts_with(options.only))
            continue;
        const bench::BenchMesh mesh = bench::generate(entry, options.quick);
        const MeshView mesh_view = mesh.mesh_view();
        const GeometryView geometry{{&mesh_view, 1}, {}};
        const SahIntersector cpu(geometry, {});
        const auto sets = bench::make_ray_sets(mesh, cpu);
        std::vector<std::vector<Hit>> expected;
        for (const bench::RaySet& set : sets)
            expected.push_back(answers(cpu, set));
        for (const CudaTree tree : {CudaTree::binary, CudaTree::wide}) {
            RayTracer tracer(options.side, geometry, tree, TriangleTest::watertight);
            for (const RayThreads threads : {RayThreads::one_a_ray, RayThreads::persistent}) {
                const bool persistent = threads == RayThreads::persistent;
                if (persistent && tree == CudaTree::binary)
                    continue;
                RayResult& result = results.emplace_back(RayResult{mesh.name,
                                                                   mesh.triangles.size(),
                                                                   tree,
                                                                   threads,
                                                                   tracer.stats().build_s,
                                                                   tracer.upload_s(),
                                                                   tracer.stats().bytes,
                                                                   {}});
                for (std::size_t i = 0; i < sets.size(); ++i) {
                    if (sets[i].rays.empty() || (persistent && sets[i].any_hit()))
                        continue;
                    result.cells.push_back(
                        measure(tracer, sets[i], expected[i], threads,
                                options.side == RaySide::device ? options.repetitions : 1));
                    print(result, result.cells.back());
                }
            }
        }
    }
}

std::string to_json(const RayResult& r) {
    std::vector<std::string> cells;
    for (const RayCell& c : r.cells) {
        std::vector<std::string> members{
            json_member("rays", json_text(bench::name_of(c.kind))),
            json_member("count", std::to_string(c.rays)),
            json_member("median_mrays_per_s", json_number(c.mrays_s)),
            json_member("nodes_per_ray", json_number(c.nodes)),
            json_member("triangles_per_ray", json_number(c.primitives)),
            json_member("wrong", std::to_string(c.wrong))};
        for (const KernelReport& k : c.kernels) {
            members.push_back(json_member("registers", std::to_string(k.registers)));
            members.push_back(json_member("occupancy", json_number(k.occupancy)));
        }
        cells.push_back(json_joined(members, '{', '}'));
    }
    return json_joined(
        {json_member("mesh", json_text(r.mesh)),
         json_member("triangles", std::to_string(r.triangles)),
         json_member("tree", json_text(name_of(r.tree))),
         json_member("threads", json_text(name_of(r.threads))),
         json_member("build_ms", json_number(1e3 * r.build_s)),
         json_member("upload_ms", json_number(1e3 * r.upload_s)),
         json_member("bytes_per_triangle",
                     json_number(static_cast<double>(r.bytes) / static_cast<double>(r.triangles))),
         json_member("cells", json_joined(cells, '[', ']', ",\n      "))},
        '{', '}');
}

} // namespace plumb::gpu
