#include "renderer/report.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdio>
#include <sys/resource.h>
#include <unistd.h>

namespace plumb {
namespace {

std::string seconds(double s) {
    if (s < 1)
        return fmt::format("{:.0f} ms", s * 1e3);
    return s < 120 ? fmt::format("{:.2f} s", s)
                   : fmt::format("{:.0f} min {:02.0f} s", std::floor(s / 60), std::fmod(s, 60));
}

std::string json_string(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            out += fmt::format("\\{}", c);
        else if (static_cast<unsigned char>(c) < 0x20)
            out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        else
            out += c;
    }
    return out + "\"";
}

double mega(std::uint64_t count, double s) {
    return s > 0 ? static_cast<double>(count) * 1e-6 / s : 0;
}

std::string percent(double share) {
    return std::isfinite(share) ? fmt::format("{:.3g} %", share * 100) : "unknown";
}

/// A number for JSON, which has no infinity.
std::string json_number(double x) { return std::isfinite(x) ? fmt::format("{:.6g}", x) : "null"; }

std::string why_it_ended(const RunReport& r) {
    const Reached& reached = *r.render.reached;
    std::string out = fmt::format("stopped by {}: error {}", name_of(r.render.stopped_by),
                                  percent(reached.error));
    if (r.stop.target_error > 0)
        out += fmt::format(", target {}", percent(r.stop.target_error));
    return out + fmt::format("; {} to {} samples a pixel, mean {:.1f}\n", reached.spp_min,
                             reached.spp_max, reached.spp_mean);
}

/// How many samples a pixel there will be, as far as one can say.
std::string samples_ahead(std::uint32_t spp, const StopSettings& stop) {
    if (!stop.any())
        return fmt::format("{} a pixel", spp);
    std::string until;
    if (stop.target_error > 0)
        until = fmt::format("the error is {}", percent(stop.target_error));
    if (stop.time_limit_s > 0)
        until += fmt::format("{}{} have passed", until.empty() ? "" : " or ",
                             seconds(stop.time_limit_s));
    return fmt::format("until {}, at most {} a pixel", until, spp);
}

double mebibytes(std::size_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

} // namespace

ProgressPrinter::ProgressPrinter(bool quiet, double target_error)
    : target_error_(target_error), quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressPrinter::~ProgressPrinter() {
    if (printed_ && terminal_)
        fmt::print(stderr, "\r\x1b[K");
}

void ProgressPrinter::update(const ProgressState& state) {
    if (quiet_)
        return;
    const std::scoped_lock lock(mutex_);
    const auto now = Clock::now();
    const double since_s = std::chrono::duration<double>(now - last_).count();
    const bool due = terminal_ ? since_s >= 0.1 : since_s >= 1 && state.done - last_done_ >= 0.1;
    if (!due || !(state.done > 0 && state.done < 1))
        return;
    last_ = now;
    last_done_ = state.done;
    print(state, std::chrono::duration<double>(now - start_).count());
}

void ProgressPrinter::print(const ProgressState& state, double elapsed_s) {
    printed_ = true;
    const double done = state.done;
    std::string text =
        fmt::format("{:3.0f} %  {:.2f} Mrays/s  {} left", done * 100, mega(state.rays, elapsed_s),
                    seconds(elapsed_s / done * (1 - done)));
    if (state.error > 0)
        text += fmt::format("  error {}, target {}", percent(state.error), percent(target_error_));
    if (!terminal_) {
        fmt::print(stderr, "{}\n", text);
        return;
    }
    constexpr int width = 30;
    const int full = static_cast<int>(done * width);
    fmt::print(stderr, "\r[{:#<{}}{: <{}}] {} \x1b[K", "", full, "", width - full, text);
}

std::uint64_t hash_of(const Image& image) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto add = [&hash](float value) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        for (int shift = 0; shift < 32; shift += 8)
            hash = (hash ^ ((bits >> shift) & 0xffu)) * 0x100000001b3u;
    };
    for (const Rgb& p : image.pixels) {
        add(p.r);
        add(p.g);
        add(p.b);
    }
    return hash;
}

std::size_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

std::string closing_table(const RunReport& r) {
    const RayCounts& rays = r.render.rays;
    std::string out;
    out += fmt::format("load {}, build {}, render {}, write {}\n", seconds(r.load_s),
                       seconds(r.build.build_s), seconds(r.render.render_s), seconds(r.write_s));
    out += fmt::format(
        "{} rays: {} camera, {} bounce, {} shadow; {:.2f} Mrays/s, {:.3f} Mpaths/s\n", rays.total(),
        rays.camera, rays.bounce, rays.shadow, mega(rays.total(), r.render.render_s),
        mega(r.render.samples, r.render.render_s));
    out += fmt::format("accel {} ({:.1f} MiB), kernel {}, {} on {}, peak memory {:.0f} MiB, image "
                       "{:016x}\n",
                       r.accel, mebibytes(r.build.bytes), r.render.profile,
                       r.threads == 1 ? "1 thread" : fmt::format("{} threads", r.threads), r.device,
                       mebibytes(r.peak_bytes), r.image_hash);
    if (r.render.reached)
        out += why_it_ended(r);
    return out;
}

std::string to_json(const RunReport& r, const Scene& scene) {
    const RayCounts& rays = r.render.rays;
    const AccelStats& b = r.build;
    std::string out = "{\n";
    const auto line = [&out](std::string_view key, const std::string& value, bool last = false) {
        out += fmt::format("  {}: {}{}\n", json_string(key), value, last ? "" : ",");
    };
    line("version", json_string(PLUMB_VERSION));
    line("scene", json_string(r.scene));
    line("accel", json_string(r.accel));
    line("device", json_string(r.device));
    line("profile", json_string(r.render.profile));
    line("threads", std::to_string(r.threads));
    line("width", std::to_string(scene.film.crop.width));
    line("height", std::to_string(scene.film.crop.height));
    line("spp", std::to_string(scene.sampler.spp));
    line("seed", std::to_string(scene.sampler.seed));
    line("samples", std::to_string(r.render.samples));
    line("stopped_by", json_string(name_of(r.render.stopped_by)));
    if (r.stop.target_error > 0)
        line("target_error", json_number(r.stop.target_error));
    if (r.stop.time_limit_s > 0)
        line("time_limit_s", json_number(r.stop.time_limit_s));
    if (const auto& reached = r.render.reached)
        line("reached", fmt::format("{{ \"error\": {}, \"spp_min\": {}, \"spp_mean\": {:.3f}, "
                                    "\"spp_max\": {} }}",
                                    json_number(reached->error), reached->spp_min,
                                    reached->spp_mean, reached->spp_max));
    line("load_s", fmt::format("{:.6f}", r.load_s));
    line("build_s", fmt::format("{:.6f}", b.build_s));
    line("render_s", fmt::format("{:.6f}", r.render.render_s));
    line("write_s", fmt::format("{:.6f}", r.write_s));
    line("total_s", fmt::format("{:.6f}", r.total_s));
    line("rays", fmt::format("{{ \"camera\": {}, \"bounce\": {}, \"shadow\": {}, \"total\": {} }}",
                             rays.camera, rays.bounce, rays.shadow, rays.total()));
    line("mrays_per_s", fmt::format("{:.4f}", mega(rays.total(), r.render.render_s)));
    line("mpaths_per_s", fmt::format("{:.4f}", mega(r.render.samples, r.render.render_s)));
    line("tree", fmt::format("{{ \"bytes\": {}, \"nodes\": {}, \"leaves\": {}, \"primitives\": {}, "
                             "\"skipped\": {}, \"depth\": {}, \"sah_cost\": {:.6g} }}",
                             b.bytes, b.node_count, b.leaf_count, b.primitive_count,
                             b.skipped_count, b.depth, b.sah_cost));
    if (r.validation)
        line("validation", to_json(*r.validation));
    line("peak_bytes", std::to_string(r.peak_bytes));
    line("image_hash", json_string(fmt::format("{:016x}", r.image_hash)), true);
    return out + "}\n";
}

std::string explain(const Scene& scene, const Features& needed, const StopSettings& stop) {
    std::size_t emissive = 0;
    for (const Surface& surface : scene.surfaces)
        emissive += is_black(surface.emission) ? 0u : 1u;
    std::string features;
    const auto feature = [&features](bool present, std::string_view name) {
        if (present)
            features += fmt::format("{}{}", features.empty() ? "" : ", ", name);
    };
    feature(needed.spheres, "spheres");
    feature(needed.smooth_normals, "smooth normals");
    feature(needed.many_lights, "several lights");
    feature(needed.triangle_lights, "triangle lights");
    feature(needed.point_lights, "point lights");
    feature(needed.environment, "environment");
    std::string out;
    out += fmt::format("geometry   {} triangles in {} meshes, {} spheres\n", scene.triangle_count(),
                       scene.meshes.size(), scene.spheres.size());
    out += fmt::format("materials  {} diffuse\n", scene.materials.size());
    out +=
        fmt::format("lights     {} surfaces, {} points, {}\n", emissive, scene.point_lights.size(),
                    is_black(scene.environment) ? "no environment" : "a constant environment");
    const Crop& crop = scene.film.crop;
    out += fmt::format("film       {} x {}, crop {} x {} at ({}, {})\n", scene.film.width,
                       scene.film.height, crop.width, crop.height, crop.x, crop.y);
    out += fmt::format("samples    {}, {}\n", samples_ahead(scene.sampler.spp, stop),
                       scene.sampler.kind == SamplerKind::sobol ? "Owen-scrambled Sobol'"
                                                                : "independent");
    out += fmt::format("needs      {}\n",
                       features.empty() ? "flat triangles and one rectangle light" : features);
    out += fmt::format("kernel     profile '{}'\n", profile_name(needed));
    for (const std::string& line : scene.ignored)
        out += fmt::format("ignored    {}\n", line);
    return out;
}

} // namespace plumb
