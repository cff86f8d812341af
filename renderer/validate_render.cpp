#include "renderer/validate_render.h"

#include <fmt/format.h>

namespace plumb {
namespace {

constexpr std::size_t kept_explained = 10000;
constexpr std::size_t printed_offenders = 5;

BuildOptions second_options(const Options& options) {
    BuildOptions build = options.build;
    if (*options.validate == AccelKind::embree) // the only test that Embree has
        build.triangle_test = TriangleTest::watertight;
    return build;
}

ValidationOptions comparison(const Options& options, const Camera& camera) {
    ValidationOptions how;
    how.keep_explained = options.replay_all ? kept_explained : 0;
    // All rays of a pinhole start at one point; a bounce from there would need a surface there.
    how.is_camera_ray = [origin = camera.origin](const Ray& ray) { return ray.origin == origin; };
    return how;
}

double per_million(std::uint64_t count, std::uint64_t all) {
    return all > 0 ? 1e6 * static_cast<double>(count) / static_cast<double>(all) : 0;
}

std::string_view meaning_of(Agreement agreement) {
    switch (agreement) {
    case Agreement::equal: return "the same bits";
    case Agreement::ulps: return "the same primitive, t, u, v within rounding";
    case Agreement::tie: return "another primitive at the same t";
    case Agreement::shared_edge: return "the neighbour across an edge or a corner";
    case Agreement::range: return "tmin or tmax at the hit, within rounding";
    case Agreement::boundary: return "past an outline, within rounding";
    case Agreement::inexact: return "t, u or v off by more than rounding";
    case Agreement::miss: return "a certain hit not found";
    case Agreement::false_hit: return "a hit that is none";
    case Agreement::leak: return "through a closed edge or corner";
    }
    return "";
}

std::string text_of(const Hit& hit) {
    return hit.valid() ? fmt::format("{}:{} at t {}", hit.geometry, hit.primitive, hit.t) : "miss";
}

/// Position on the film in pixels of the camera ray; empty for other rays.
std::string film_place(const ValidationResult& r, const Disagreement& d) {
    if (d.kind != RayKind::camera)
        return "";
    const Camera& c = r.camera;
    const Vec3 from = d.ray.direction - c.corner; // = x dx + y dy
    const float xx = dot(c.dx, c.dx), xy = dot(c.dx, c.dy), yy = dot(c.dy, c.dy);
    const float fx = dot(from, c.dx), fy = dot(from, c.dy), det = xx * yy - xy * xy;
    return fmt::format(", film ({:.2f}, {:.2f})",
                       (fx * yy - fy * xy) / det * static_cast<float>(r.width),
                       (fy * xx - fx * xy) / det * static_cast<float>(r.height));
}

std::string offender(const ValidationResult& r, const Disagreement& d) {
    const Answers& a = d.answers;
    const auto answer = [&](const Hit& hit, bool found) {
        return (a.any_hit ? (found ? "blocked, " : "free, ") : "") + text_of(hit);
    };
    const Ray& ray = d.ray;
    return fmt::format(
        "  {} ({} wrong): {} ray{}\n    origin ({} {} {}) direction ({} {} {}) t {} to {}\n"
        "    {}: {}; {}: {}\n",
        name_of(d.verdict.agreement),
        d.verdict.culprit == Culprit::first    ? name_of(r.first)
        : d.verdict.culprit == Culprit::second ? name_of(r.second)
                                               : name_of(d.verdict.culprit),
        name_of(d.kind), film_place(r, d), ray.origin.x, ray.origin.y, ray.origin.z,
        ray.direction.x, ray.direction.y, ray.direction.z, ray.tmin, ray.tmax, name_of(r.first),
        answer(a.first, a.first_found), name_of(r.second), answer(a.second, a.second_found));
}

std::string histogram_line(std::string_view name, const UlpHistogram& bins) {
    std::string out = fmt::format("  {:<24}", name);
    for (std::size_t i = 0; i < bins.size(); ++i)
        out += fmt::format("{}{}: {}", i > 0 ? ", " : "", ulp_bin_names[i], bins[i]);
    return out + "\n";
}

std::string histogram_json(const UlpHistogram& bins) {
    std::string out;
    for (std::size_t i = 0; i < bins.size(); ++i)
        out += fmt::format("{}\"{}\": {}", i > 0 ? ", " : "", ulp_bin_names[i], bins[i]);
    return "{ " + out + " }";
}

} // namespace

RenderValidation::RenderValidation(const Options& options, const Scene& scene,
                                   const SceneView& view, const Intersector& first)
    : options_(options), scene_(scene), view_(view),
      second_(make_intersector(*options.validate, view.geometry, second_options(options))),
      both_(view.geometry, first, *second_, comparison(options, view.camera)) {}

ValidationResult RenderValidation::result() const {
    ValidationResult result;
    result.first = options_.accel;
    result.second = *options_.validate;
    result.report = both_.report();
    result.replay_file = options_.replay_file.empty() ? "validate.replay" : options_.replay_file;
    result.camera = view_.camera;
    result.width = scene_.film.width;
    result.height = scene_.film.height;
    std::vector<Disagreement> rays = result.report.unexplained;
    rays.insert(rays.end(), result.report.explained.begin(), result.report.explained.end());
    if (!rays.empty()) {
        result.replay = make_replay(view_.geometry, std::move(rays));
        result.replay.scene = options_.scene.file.string();
        result.replay.triangle_test = options_.build.triangle_test;
        result.replay.first = result.first;
        result.replay.second = result.second;
    }
    return result;
}

std::string table_of(const ValidationResult& r) {
    const ValidationReport& v = r.report;
    std::string out = fmt::format(
        "validation of {} against {}: {} rays: {} camera, {} bounce, {} shadow\n", name_of(r.first),
        name_of(r.second), v.ray_count(), v.rays[0], v.rays[1], v.rays[2]);
    out += fmt::format("  {:<12}{:>14}{:>14}  {}\n", "", "rays", "per million", "what it is");
    for (std::size_t i = 0; i < agreement_count; ++i) {
        const auto agreement = static_cast<Agreement>(i);
        const std::uint64_t count = v.count(agreement);
        out += fmt::format("  {:<12}{:>14}{:>14.3f}  {}", name_of(agreement), count,
                           per_million(count, v.ray_count()), meaning_of(agreement));
        if (!is_explained(agreement) && count > 0)
            out += fmt::format("; wrong: {} {}, {} {}, both {}", name_of(r.first), v.counts[i][1],
                               name_of(r.second), v.counts[i][2], v.counts[i][3]);
        out += '\n';
    }
    out += histogram_line("t apart, ulp", v.t_ulps);
    out += histogram_line("u, v apart, ulp of 1", v.uv_ulps);
    out += fmt::format("  {:<24}t {} ulp, {:.2f} of the bound; u and v {} ulp of 1\n",
                       "worst explained", v.worst_t_ulps, v.worst_share, v.worst_uv_ulps);
    if (v.unchecked > 0)
        out += fmt::format("  {} disagreements were not searched for leaks: there are too many\n",
                           v.unchecked);
    for (std::size_t i = 0; i < std::min(printed_offenders, v.unexplained.size()); ++i)
        out += offender(r, v.unexplained[i]);
    out += fmt::format("  unexplained: {}\n", v.unexplained_count());
    return out;
}

std::string to_json(const ValidationResult& r) {
    const ValidationReport& v = r.report;
    std::string out = fmt::format(
        "{{\n    \"first\": \"{}\", \"second\": \"{}\",\n"
        "    \"rays\": {{ \"camera\": {}, \"bounce\": {}, \"shadow\": {}, \"total\": {} }},\n",
        name_of(r.first), name_of(r.second), v.rays[0], v.rays[1], v.rays[2], v.ray_count());
    for (std::size_t i = 0; i < agreement_count; ++i) {
        const auto agreement = static_cast<Agreement>(i);
        out += fmt::format("    \"{}\": {{ \"count\": {}, \"per_million\": {:.6f}, "
                           "\"first_wrong\": {}, \"second_wrong\": {}, \"both_wrong\": {} }},\n",
                           name_of(agreement), v.count(agreement),
                           per_million(v.count(agreement), v.ray_count()), v.counts[i][1],
                           v.counts[i][2], v.counts[i][3]);
    }
    out += fmt::format("    \"t_ulps\": {},\n    \"uv_ulps\": {},\n", histogram_json(v.t_ulps),
                       histogram_json(v.uv_ulps));
    out += fmt::format("    \"worst_t_ulps\": {}, \"worst_uv_ulps\": {}, \"worst_share_of_bound\": "
                       "{:.4f},\n    \"unchecked\": {},\n"
                       "    \"unexplained\": {}\n  }}",
                       v.worst_t_ulps, v.worst_uv_ulps, v.worst_share, v.unchecked,
                       v.unexplained_count());
    return out;
}

} // namespace plumb
