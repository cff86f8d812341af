#include "tools/bench_src/validate_mesh.h"

#include "tools/bench_src/random.h"
#include "tools/bench_src/ray_sets.h"

#include <algorithm>
#include <fmt/format.h>

namespace plumb::bench {
namespace {

constexpr std::size_t batch_size = 256;

void trace_as_streams(const Intersector& both, const std::vector<Ray>& rays, bool any_hit) {
    std::vector<Hit> hits(batch_size);
    std::vector<std::uint8_t> found(batch_size);
    for (std::size_t begin = 0; begin < rays.size(); begin += batch_size) {
        const std::size_t count = std::min(batch_size, rays.size() - begin);
        const std::span<const Ray> part(&rays[begin], count);
        if (any_hit)
            both.occluded(part, std::span(found).first(count));
        else
            both.closest(part, std::span(hits).first(count));
    }
}

std::vector<Ray> random_segments(const Bounds& box, std::size_t count, Random& random) {
    std::vector<Ray> rays;
    while (rays.size() < count) {
        const Vec3 from = random.point(box.lower, box.upper);
        const Ray ray{from, 0, random.point(box.lower, box.upper) - from, 1};
        if (is_valid(ray))
            rays.push_back(ray);
    }
    return rays;
}

/// Rays on which this one, or both, answered wrongly.
std::uint64_t wrong_answers(const ValidationReport& report, Culprit culprit) {
    std::uint64_t count = 0;
    for (const auto& by_culprit : report.counts)
        count += by_culprit[static_cast<std::size_t>(culprit)] +
                 by_culprit[static_cast<std::size_t>(Culprit::both)];
    return count;
}

} // namespace

ValidationReport validate_mesh(const BenchMesh& mesh, const ValidateOptions& options,
                               Progress& progress) {
    progress.stage(fmt::format("{}: building", mesh.name));
    const MeshView view = mesh.mesh_view();
    const GeometryView geometry{{&view, 1}, {}};
    const auto sah = make_intersector(AccelKind::sah, geometry, options.sah);
    const auto other = make_intersector(options.other, geometry);
    const ValidatingIntersector both(geometry, *sah, *other);
    std::size_t traced = 0;
    progress.stage(fmt::format("{}: tracing", mesh.name));
    for (const RaySet& set : make_ray_sets(mesh, *sah)) {
        trace_as_streams(both, set.rays, set.any_hit());
        traced += set.rays.size();
    }
    Random random(20230);
    const Bounds box = bounds_of(mesh);
    constexpr std::size_t at_once = std::size_t{1} << 16u;
    for (bool single = false; traced < options.rays; single = !single) {
        progress.detail(fmt::format("{:.0f} of {:.0f} M rays", 1e-6 * static_cast<double>(traced),
                                    1e-6 * static_cast<double>(options.rays)));
        const std::vector<Ray> rays =
            random_segments(box, std::min(at_once, options.rays - traced), random);
        if (single)
            for (const Ray& ray : rays)
                static_cast<void>(both.closest(ray));
        else
            trace_as_streams(both, rays, false);
        traced += rays.size();
    }
    return both.report();
}

std::string validation_head() {
    std::string line = fmt::format("{:<12}{:>12}", "mesh", "rays");
    for (std::size_t i = 0; i < agreement_count; ++i)
        line += fmt::format("{:>12}", name_of(static_cast<Agreement>(i)));
    return line + fmt::format("{:>12}{:>12}\n", "sah wrong", "other wrong");
}

std::string validation_line(std::string_view mesh, const ValidationReport& report) {
    std::string line = fmt::format("{:<12}{:>12}", mesh, report.ray_count());
    for (std::size_t i = 0; i < agreement_count; ++i)
        line += fmt::format("{:>12}", report.count(static_cast<Agreement>(i)));
    return line + fmt::format("{:>12}{:>12}\n", wrong_answers(report, Culprit::first),
                              wrong_answers(report, Culprit::second));
}

} // namespace plumb::bench
