#include "tools/bench_src/options.h"

#include "renderer/io/nearest_name.h"
#include "renderer/unknown_argument.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <iterator>

namespace plumb::bench {
namespace {

constexpr const char* description =
    "Times ray queries: Plumbline's trees beside Embree, on one thread, in one run.\n\n"
    "For each mesh every structure is built, five kinds of rays are made (camera rays, shadow\n"
    "rays, first and later diffuse bounces, random segments), and all configurations trace them\n"
    "in turn. The tables show millions of rays a second and the ratios to the fastest Embree;\n"
    "answers are compared with those of the plain tree ('wrong' counts the rays that differ).";

constexpr const char* footer =
    "Examples:\n"
    "  bench --quick                                small meshes, a few seconds\n"
    "  bench --meshes hall,hair --rays primary      two meshes, camera rays only\n"
    "  bench --mesh bunny.ply --configs 'sah/*'     a file, every variant of our own tree\n"
    "  bench --json bench.json                      everything: about a quarter of an hour\n"
    "Exit codes: 0 done, 2 usage, 4 a mesh cannot be read, 5 the JSON cannot be written,\n"
    "6 resources, 70 internal.";

constexpr const char* list_text = "Generated meshes (--meshes), * for several:\n";

/// What the flags say, before names are looked up.
struct Raw {
    std::vector<std::string> meshes, configs, rays;
    bool list = false;
    std::string validate, quality, device;
    double validate_rays = 0; ///< 0: not given
};

template <class Range, class Name>
std::vector<std::string_view> names_of(const Range& range, Name&& name) {
    std::vector<std::string_view> names;
    names.reserve(std::size(range));
    for (const auto& item : range)
        names.emplace_back(name(item));
    return names;
}

/// Calls take(i) for every name that one of the patterns matches, in the order of the names. Throws
/// for a pattern that matches none.
template <class F>
void select(const char* flag, const std::vector<std::string>& patterns,
            const std::vector<std::string_view>& names, F&& take) {
    std::vector<bool> chosen(names.size());
    for (const std::string& pattern : patterns) {
        bool found = false;
        for (std::size_t i = 0; i < names.size(); ++i)
            if (matches_glob(pattern, names[i])) {
                chosen[i] = true;
                found = true;
            }
        if (!found)
            throw CLI::ValidationError(
                flag, fmt::format("nothing is called '{}'{}; --list shows the names", pattern,
                                  did_you_mean(pattern, names)));
    }
    for (std::size_t i = 0; i < names.size(); ++i)
        if (chosen[i])
            take(i);
}

void look_up(const Raw& raw, Options& options) {
    const auto entries = catalogue();
    const auto mesh_names = names_of(entries, [](const CatalogueEntry& e) { return e.name; });
    std::vector<std::string> mesh_patterns = raw.meshes;
    if (mesh_patterns.empty() && options.files.empty())
        mesh_patterns = {"*"};
    select("--meshes", mesh_patterns, mesh_names,
           [&](std::size_t i) { options.meshes.push_back(&entries[i]); });

    if (raw.device == "cuda")
        options.cuda = RaySide::device;
    else if (raw.device == "cuda-host")
        options.cuda = RaySide::host;
    const std::vector<Config> configs = all_configs(options.threads, options.cuda);
    if (raw.configs.empty())
        std::copy_if(configs.begin(), configs.end(), std::back_inserter(options.measure.configs),
                     [](const Config& config) { return config.by_default; });
    else
        select("--configs", raw.configs,
               names_of(configs, [](const Config& c) -> std::string_view { return c.name; }),
               [&](std::size_t i) { options.measure.configs.push_back(configs[i]); });
    options.all_naive = !raw.configs.empty();

    const auto kind_names = names_of(ray_kinds, [](RayKind kind) { return name_of(kind); });
    select("--rays", raw.rays.empty() ? std::vector<std::string>{"*"} : raw.rays, kind_names,
           [&](std::size_t i) { options.measure.kinds.push_back(ray_kinds[i]); });
}

void look_up_validation(const Raw& raw, Options& options) {
    if (raw.validate.empty()) {
        if (raw.validate_rays > 0 || !raw.quality.empty())
            throw CLI::ValidationError(
                raw.validate_rays > 0 ? "--validate-rays" : "--build-quality", "needs --validate");
        return;
    }
    if (!options.json.empty() || !raw.configs.empty() || !raw.rays.empty())
        throw CLI::ValidationError("--validate", "excludes --json, --configs and --rays");
    ValidateOptions& validate = options.validate.emplace();
    validate.other = raw.validate == "naive" ? AccelKind::naive : AccelKind::embree;
    for (const BuildQuality quality :
         {BuildQuality::fast, BuildQuality::medium, BuildQuality::high})
        if (raw.quality == name_of(quality))
            validate.sah.quality = quality;
    const double rays = raw.validate_rays > 0 ? raw.validate_rays : options.quick ? 1e5 : 1.25e7;
    validate.rays = static_cast<std::size_t>(rays);
}

void print_list(int threads) {
    std::string out = list_text;
    for (const CatalogueEntry& entry : catalogue())
        out += fmt::format("  {:<12} {}\n", entry.name, entry.description);
    out += "Rays (--rays):\n";
    for (const RayKind kind : ray_kinds)
        out += fmt::format("  {:<12} {}\n", name_of(kind), description_of(kind));
    out += "Configurations (--configs); those with a + run by default:\n";
    for (const Config& config : all_configs(threads, RaySide::device))
        out += fmt::format("{} {}\n", config.by_default ? " +" : "  ", config.name);
    std::fputs(out.c_str(), stdout);
}

void add_selection(CLI::App& app, Options& options, Raw& raw) {
    app.add_option("--meshes", raw.meshes, "Generated meshes to trace, comma-separated [all]")
        ->delimiter(',')
        ->type_name("NAME,...");
    app.add_option("--mesh", options.files, "An obj or ply file to trace; may be repeated")
        ->type_name("FILE");
    app.add_option("--rays", raw.rays, "Kinds of rays [all]")
        ->delimiter(',')
        ->type_name("NAME,...");
    app.add_option("--configs", raw.configs,
                   "Configurations; * stands for any characters [all Embree medium and high, sah\n"
                   "medium and high at the best instruction set, naive up to 400,000 triangles]")
        ->delimiter(',')
        ->type_name("NAME,...");
    app.add_option("--device", raw.device,
                   "cuda: the kernels of the GPU beside all others, timed by themselves, without\n"
                   "the way of rays and answers; cuda-host: the same kernels in a loop [cpu]")
        ->check(CLI::IsMember({"cpu", "cuda", "cuda-host"}))
        ->type_name("cpu|cuda|cuda-host");
    app.add_option("--validate", raw.validate,
                   "Compare every ray of sah with this structure and classify what differs,\n"
                   "instead of timing; exit code 1 if anything is unexplained")
        ->check(CLI::IsMember({"naive", "embree"}))
        ->type_name("naive|embree");
    app.add_option("--validate-rays", raw.validate_rays,
                   "Rays of each mesh: its sets, then random segments [12500000; --quick: 100000]")
        ->check(CLI::Range(1.0, 1e12));
    app.add_option("--build-quality", raw.quality, "Of sah, for --validate [medium]")
        ->check(CLI::IsMember({"fast", "medium", "high"}))
        ->type_name("fast|medium|high");
    app.add_option("--replay", options.replay,
                   "Trace the rays of a replay file (renderer --validate) through all structures,\n"
                   "with the geometry in it alone; exit code 1 if anything is unexplained")
        ->type_name("FILE");
    app.add_flag("--list", raw.list, "Print all these names and exit");
    app.add_flag("--quick", options.quick, "Small versions of the meshes, short repetitions");
}

void add_protocol(CLI::App& app, Options& options) {
    app.add_option("--repetitions", options.measure.repetitions,
                   "Interleaved repetitions, of which the median is shown [5; --quick: 3]")
        ->check(CLI::Range(1, 1000));
    app.add_option("--seconds", options.measure.seconds,
                   "Least time of each repetition of each configuration [0.05; --quick: 0.002]")
        ->check(CLI::Range(0.0, 60.0));
    app.add_option("--builds", options.measure.builds,
                   "Builds of each structure; one where the mesh has over a million triangles [3]")
        ->check(CLI::Range(1, 100));
    app.add_option("--threads", options.threads, "Threads of the builds; 0: all cores [1]")
        ->check(CLI::Range(0, 1024));
    app.add_option("--json", options.json, "Write everything that was measured")->type_name("FILE");
    app.add_flag("--quiet,-q", options.quiet, "No progress on stderr");
}

std::string join(int argc, const char* const* argv) {
    std::string line;
    for (int i = 0; i < argc; ++i)
        line += (i > 0 ? " " : "") + std::string(argv[i]);
    return line;
}

/// --quick, where the flags do not say otherwise.
void make_quick(const CLI::App& app, MeasureOptions& measure) {
    if (app.count("--repetitions") == 0)
        measure.repetitions = 3;
    if (app.count("--seconds") == 0)
        measure.seconds = 0.002;
    if (app.count("--builds") == 0)
        measure.builds = 1;
}

} // namespace

ParsedOptions parse_options(int argc, const char* const* argv) {
    ParsedOptions parsed;
    Options& options = parsed.options;
    Raw raw;
    CLI::App app(description, "bench");
    app.set_version_flag("--version", "Plumbline " PLUMB_VERSION);
    app.footer(footer);
    add_selection(app, options, raw);
    add_protocol(app, options);
    app.allow_extras();
    try {
        app.parse(argc, argv);
        if (!app.remaining().empty())
            throw CLI::ExtrasError(app.remaining());
        if (options.quick)
            make_quick(app, options.measure);
        look_up(raw, options);
        look_up_validation(raw, options);
    } catch (const CLI::Success& request) {
        parsed.exit_code = app.exit(request);
        return parsed;
    } catch (const CLI::ParseError& error) {
        const std::string what = app.remaining().empty() ? error.what() : unknown_argument(app);
        fmt::print(stderr, "error: {} (see --help)\n", what);
        parsed.exit_code = 2;
        return parsed;
    }
    if (raw.list) {
        print_list(options.threads);
        parsed.exit_code = 0;
    }
    options.command_line = join(argc, argv);
    return parsed;
}

} // namespace plumb::bench
