/// \file  The command line program: one straight line from scene to image.

#include "accel/parallel/parallel.h"
#include "accel/sah/build_compressed.h"
#include "accel/sah/build_sah.h"
#include "cuda/cuda_render.h"
#include "cuda/ray_tracer.h"
#include "renderer/io/write_file.h"
#include "renderer/options.h"
#include "renderer/report.h"
#include "renderer/scene/error.h"
#include "renderer/scene/scene_tables.h"
#include "renderer/validate_render.h"

#include <fmt/format.h>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <new>

namespace plumb {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::atomic<bool> cancelled{false};
std::atomic<int> caught_signal{0};

/// SIGINT, SIGTERM, SIGHUP: each thread ends within 64 samples and what is there is written.
extern "C" void request_stop(int signal_number) {
    caught_signal = signal_number;
    cancelled = true;
}

void default_outputs(Options& options) {
    if (!options.outputs.files.empty())
        return;
    const std::filesystem::path name = options.scene.file.stem();
    options.outputs.files = {name.string() + ".exr", name.string() + ".png"};
}

Metadata metadata_of(const Options& options, const Scene& scene, const RunReport& report) {
    // A number of samples that tools may divide a variance by: that of every pixel, or the mean.
    const double spp = report.render.reached ? std::round(report.render.reached->spp_mean)
                                             : static_cast<double>(scene.sampler.spp);
    return {{"software", "plumbline " PLUMB_VERSION},
            {"commandLine", options.command_line},
            {"sceneFile", options.scene.file.string()},
            {"spp", static_cast<int>(spp)},
            {"seed", std::to_string(scene.sampler.seed)},
            {"accelerator", report.accel},
            {"renderSeconds", static_cast<float>(report.render.render_s)}};
}

void print_lines(const std::vector<std::string>& lines) {
    for (const std::string& line : lines)
        fmt::print(stderr, "{}\n", line);
}

/// Says on stderr why --device=auto does without a GPU.
void note_fallback(const Options& options, std::string_view why) {
    if (!options.quiet)
        fmt::print(stderr, "note: rendering on the CPU: {}\n", why);
}

/// Whether a GPU renders. Throws DeviceError where --device=cuda asks for one that is not there.
bool chooses_cuda(const Options& options) {
    if (options.device == Device::cpu)
        return false;
    const bool validates = options.validate || options.validate_cuda;
    const bool reuses = options.reuse.value_or(1) > 1;
    std::string why = validates            ? "cuda: rays are validated on the CPU"
                      : options.stop.any() ? "cuda: stops neither by error nor by time"
                      : reuses             ? "cuda: pixels share no paths"
                                           : "cuda: needs --accel=sah";
    if (options.accel == AccelKind::sah && !validates && !options.stop.any() && !reuses &&
        cuda_available(&why))
        return true;
    if (options.device == Device::cuda)
        throw DeviceError(why);
    note_fallback(options, why);
    return false;
}

/// Builds the tree that the settings name, uploads it and renders there.
Film render_on_device(const Options& options, const SceneTables& tables, const RenderJob& job,
                      const Features& needed, const RenderOptions& how, RunReport& report) {
    SahTree binary;
    CompressedTree wide;
    TreeViews trees;
    if (options.cuda.tree == CudaTree::binary) {
        binary = build_sah(tables.geometry(), options.build.threads);
        trees.binary = binary.view();
        report.build = binary.stats();
    } else {
        wide = build_compressed(tables.geometry(), options.build.threads);
        trees.wide = wide.view();
        report.build = wide.stats();
    }
    report.device = "cuda";
    report.device_report.emplace();
    return render_on_cuda(job, needed, trees, options.build.triangle_test, options.cuda, how,
                          report.render, &*report.device_report);
}

Film render_with_progress(const Options& options, const Scene& scene, const SceneTables& tables,
                          RunReport& report) {
    const bool on_cuda = chooses_cuda(options);
    if (std::string why; options.validate_cuda && !cuda_available(&why))
        throw DeviceError(why);
    report.accel = name_of(options.accel);
    report.threads = thread_count(options.threads);
    report.stop = options.stop;
    ProgressPrinter progress(options.quiet, options.stop.target_error);
    RenderOptions how;
    how.threads = options.threads;
    how.variance = options.variance;
    how.force_full_profile = options.full_profile;
    how.progress = [&progress](const ProgressState& now) { progress.update(now); };
    how.stop = options.stop;
    how.cancel = &cancelled;
    const RenderJob job = make_job(scene, tables.view());
    const Features needed = features_of(scene);
    if (on_cuda) {
        try {
            return render_on_device(options, tables, job, needed, how, report);
        } catch (const DeviceError& error) {
            if (options.device == Device::cuda)
                throw;
            note_fallback(options, error.what());
            report.device = "cpu";
            report.device_report.reset();
            report.render = {};
        }
    }
    const auto intersector = make_intersector(options.accel, tables.geometry(), options.build);
    report.build = intersector->stats();
    if (options.validate_cuda) {
        const CudaIntersector device(RaySide::device, tables.geometry(), options.cuda.tree,
                                     options.build.triangle_test, options.build.threads);
        report.threads = 1;
        return validate_paths(job, needed, *intersector, device, how, report.render,
                              report.cuda_validation.emplace());
    }
    if (!options.validate)
        return render(job, needed, *intersector, how, report.render);
    const RenderValidation validation(options, scene, tables.view(), *intersector);
    Film film = render(job, needed, validation.intersector(), how, report.render);
    report.validation = validation.result();
    return film;
}

/// Prints the table of a validation and writes its replay file. Returns the exit code.
int close_validation(const Options& options, const ValidationResult& result) {
    if (!options.quiet)
        fmt::print("{}", table_of(result));
    if (!result.replay.rays.empty()) {
        atomic_write(result.replay_file, to_text(result.replay));
        if (!options.quiet)
            fmt::print("wrote {}\n", result.replay_file.string());
    }
    const std::uint64_t unexplained = result.report.unexplained_count();
    if (unexplained == 0)
        return 0;
    fmt::print(stderr,
               "error: validation: {} rays on which {} and {} disagree are unexplained "
               "({})\n",
               unexplained, name_of(result.first), name_of(result.second),
               result.replay_file.string());
    return 1;
}

/// The same for --validate=cuda, which has no replay file.
int close_validation(const Options& options, const PathValidation& found) {
    if (!options.quiet)
        fmt::print("{}", text_of(found, name_of(options.accel)));
    if (found.different.total() == 0)
        return 0;
    fmt::print(stderr, "error: validation: {} rays have other bits on cuda than with {}\n",
               found.different.total(), name_of(options.accel));
    return 1;
}

int run(Options options) {
    const auto start = Clock::now();
    RunReport report;
    report.scene = options.scene.file.string();
    Scene scene = load_scene(options.scene);
    apply_options(options, scene);
    if (!options.quiet)
        print_lines(scene.warnings);
    if (options.explain) {
        fmt::print("{}", explain(scene, features_of(scene), options.stop));
        return 0;
    }
    default_outputs(options);
    if (!options.stats_file.empty())
        check_writable(options.stats_file);
    if (!options.replay_file.empty())
        check_writable(options.replay_file);
    check_outputs(options.outputs, scene.film.crop.width, scene.film.crop.height);
    report.load_s = seconds_since(start);

    const SceneTables tables(scene);
    const Image image = render_with_progress(options, scene, tables, report).resolve();

    const auto write_start = Clock::now();
    write_images(image, options.outputs, metadata_of(options, scene, report));
    report.write_s = seconds_since(write_start);
    report.total_s = seconds_since(start);
    report.image_hash = hash_of(image);
    report.peak_bytes = peak_memory();
    if (!options.quiet) {
        fmt::print("{}", closing_table(report));
        for (const auto& file : options.outputs.files)
            fmt::print("wrote {}\n", file.string());
    }
    if (!options.stats_file.empty())
        atomic_write(options.stats_file, to_json(report, scene));
    int valid = report.validation ? close_validation(options, *report.validation) : 0;
    if (report.cuda_validation)
        valid = close_validation(options, *report.cuda_validation);
    return caught_signal != 0 ? 128 + caught_signal : valid;
}

/// The one place where exceptions become exit codes.
int run_and_report(const Options& options) {
    try {
        return run(options);
    } catch (const SceneError& error) {
        fmt::print(stderr, "{}\n", error.what());
        return error.exit_code();
    } catch (const DeviceError& error) {
        fmt::print(stderr, "error: {}\n", error.what());
        return static_cast<int>(ErrorKind::resources);
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "error: out of memory\n");
        return static_cast<int>(ErrorKind::resources);
    } catch (const std::exception& error) {
        fmt::print(stderr, "error: internal: {}\n", error.what());
        return 70;
    }
}

/// What was printed must have arrived, or a full disk would look like success.
int close_stdout(int exit_code) {
    if (std::fflush(stdout) == 0 || exit_code != 0)
        return exit_code;
    fmt::print(stderr, "error: cannot write to the standard output\n");
    return static_cast<int>(ErrorKind::output);
}

} // namespace
} // namespace plumb

int main(int argc, char** argv) {
    std::signal(SIGXFSZ, SIG_IGN); // a file-size limit is an error of write(), not the end
    for (const int signal_number : {SIGINT, SIGTERM, SIGHUP})
        std::signal(signal_number, plumb::request_stop);
    const plumb::ParsedOptions parsed = plumb::parse_options(argc, argv);
    if (parsed.options)
        return plumb::close_stdout(plumb::run_and_report(*parsed.options));
    fmt::print(parsed.exit_code == 0 ? stdout : stderr, "{}", parsed.text);
    return plumb::close_stdout(parsed.exit_code);
}
