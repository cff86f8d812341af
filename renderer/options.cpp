#include "renderer/options.h"

#include "renderer/io/parse_number.h"
#include "renderer/io/xml_text.h"
#include "renderer/stop_options.h"
#include "renderer/unknown_argument.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <map>
#include <sstream>

namespace plumb {
namespace {

template <class T> using Names = std::map<std::string, T>;

const Names<AccelKind> accel_names{
    {"naive", AccelKind::naive}, {"sah", AccelKind::sah}, {"embree", AccelKind::embree}};
const Names<TriangleTest> triangle_names{{"watertight", TriangleTest::watertight},
                                         {"moeller-trumbore", TriangleTest::moeller_trumbore},
                                         {"moller-trumbore", TriangleTest::moeller_trumbore}};
const Names<BuildQuality> quality_names{
    {"fast", BuildQuality::fast}, {"medium", BuildQuality::medium}, {"high", BuildQuality::high}};
const Names<Isa> isa_names{{"auto", Isa::automatic},
                           {"portable", Isa::portable},
                           {"avx2", Isa::avx2},
                           {"avx512", Isa::avx512}};
const Names<Device> device_names{
    {"cpu", Device::cpu}, {"cuda", Device::cuda}, {"auto", Device::automatic}};
const Names<CudaTree> cuda_tree_names{{"binary", CudaTree::binary}, {"wide", CudaTree::wide}};
const Names<CudaSchedule> cuda_schedule_names{{"megakernel", CudaSchedule::megakernel},
                                              {"wavefront", CudaSchedule::wavefront},
                                              {"persistent", CudaSchedule::persistent}};
const Names<Estimator> estimator_names{
    {"mis", Estimator::mis}, {"light", Estimator::light}, {"bsdf", Estimator::bsdf}};
const Names<int> reuse_names{{"1", 1}, {"2", 2}, {"4", 4}};
const Names<HemisphereSampling> hemisphere_names{{"cosine", HemisphereSampling::cosine},
                                                 {"uniform", HemisphereSampling::uniform}};
const Names<LightSampling> light_names{{"solid-angle", LightSampling::solid_angle},
                                       {"area", LightSampling::area}};
const Names<SamplerKind> sampler_names{{"sobol", SamplerKind::sobol},
                                       {"independent", SamplerKind::independent}};

constexpr const char* footer = R"(Examples:
  renderer scenes/cornell-box.xml                        cornell-box.exr and cornell-box.png
  renderer --spp 256 -o box.exr scenes/cornell-box.xml   one scene-linear file
  renderer --accel embree -D res=512 scenes/cornell-box.xml
Exit codes: 0 done, 1 a validation failed, 2 usage, 3 scene, 4 mesh or texture, 5 output, 6 resources,
70 internal, 128+n signal n.)";

/// An option whose values are the names of an enumeration.
template <class T, class Target>
void add_choice(CLI::App& app, const std::string& flag, Target& target, const Names<T>& names,
                const std::string& help) {
    std::string values;
    for (const auto& [name, value] : names)
        values += (values.empty() ? "" : "|") + name;
    app.add_option_function<std::string>(
           flag,
           [&target, &names, flag](const std::string& text) {
               const auto found = names.find(text);
               if (found == names.end()) {
                   std::string expected;
                   for (const auto& [name, value] : names)
                       expected += (expected.empty() ? "" : ", ") + name;
                   throw CLI::ValidationError(
                       flag, fmt::format("unknown value (got '{}', expected {})", text, expected));
               }
               target = found->second;
           },
           help)
        ->type_name(values);
}

/// A whole number within [low, high].
template <class Target>
void add_count(CLI::App& app, const std::string& flag, Target& target, std::int64_t low,
               std::int64_t high, const std::string& help) {
    app.add_option_function<std::string>(
           flag,
           [&target, flag, low, high](const std::string& text) {
               const auto number = parse_int64(text);
               if (!number || *number < low || *number > high)
                   throw CLI::ValidationError(
                       flag,
                       fmt::format("bad count (got '{}', expected {} to {})", text, low, high));
               if constexpr (std::is_same_v<Target, int>)
                   target = static_cast<int>(*number);
               else
                   target = static_cast<typename Target::value_type>(*number);
           },
           help)
        ->type_name("COUNT");
}

/// `throughput`, `none` or `constant:P` with P in (0,1].
void parse_roulette(const std::string& text, Options& options) {
    constexpr std::string_view constant = "constant:";
    if (text == "throughput" || text == "none") {
        options.roulette = text == "none" ? RouletteKind::none : RouletteKind::throughput;
        return;
    }
    const auto p = text.starts_with(constant)
                       ? parse_float(std::string_view(text).substr(constant.size()))
                       : std::nullopt;
    if (!p || !(*p > 0 && *p <= 1))
        throw CLI::ValidationError(
            "--rr", fmt::format("unknown value (got '{}', expected throughput, none or constant:P "
                                "with P in (0,1])",
                                text));
    options.roulette = RouletteKind::constant;
    options.roulette_constant = *p;
}

void add_scene_flags(CLI::App& app, Options& options) {
    app.add_option("scene", options.scene.file, "Mitsuba-style XML scene")
        ->required()
        ->type_name("SCENE.xml");
    app.add_option_function<std::vector<std::string>>(
           "-D",
           [&options](const std::vector<std::string>& definitions) {
               for (const std::string& d : definitions) {
                   const std::size_t equals = d.find('=');
                   if (equals == std::string::npos || equals == 0)
                       throw CLI::ValidationError(
                           "-D", fmt::format("bad parameter (got '{}', expected NAME=VALUE)", d));
                   options.scene.parameters.emplace_back(d.substr(0, equals), d.substr(equals + 1));
               }
           },
           "Set a $parameter of the scene")
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false);
    app.add_flag(
        "--lenient", options.scene.lenient,
        "Replace what is not supported by a substitute that is named, instead of refusing");
    app.add_flag("--explain", options.explain,
                 "Print what the scene contains and which kernel serves it, render nothing");
}

void add_speed_flags(CLI::App& app, Options& options) {
    add_choice(app, "--accel", options.accel, accel_names, "Ray queries [sah]");
    add_choice(app, "--triangle-test", options.build.triangle_test, triangle_names,
               "Triangle test of naive and sah [watertight]");
    add_choice(app, "--build-quality", options.build.quality, quality_names,
               "Time spent on the tree of sah or embree for faster rays [medium]");
    add_choice(app, "--isa", options.build.isa, isa_names,
               "Instruction set of sah; all give the same bits [auto]");
    add_choice(app, "--device", options.device, device_names,
               "Where to render; auto takes a GPU where there is one [cpu]");
    add_choice(app, "--cuda-tree", options.cuda.tree, cuda_tree_names,
               "Tree that a GPU traverses; the same bits [wide]");
    add_choice(
        app, "--cuda-schedule", options.cuda.schedule, cuda_schedule_names,
        "One kernel for whole paths on a GPU, one for each step, or likewise with persistent "
        "threads (wide tree only); the same bits [wavefront]");
    add_count(app, "--threads", options.threads, 1, 1024, "Threads [all cores]");
    app.add_flag("--full-profile", options.full_profile,
                 "Use the general kernel whatever the scene needs (same bits, slower)");
}

/// --validate: a second structure, or a GPU.
void add_validate(CLI::App& app, Options& options) {
    app.add_option_function<std::string>(
           "--validate",
           [&options](const std::string& text) {
               const auto found = accel_names.find(text);
               if (found == accel_names.end() && text != "cuda")
                   throw CLI::ValidationError(
                       "--validate",
                       fmt::format("unknown value (got '{}', expected embree, naive, sah, cuda)",
                                   text));
               options.validate_cuda = text == "cuda";
               options.validate.reset();
               if (found != accel_names.end())
                   options.validate = found->second;
           },
           "Trace the render's rays with a second structure too, classify every disagreement; "
           "exit 1 if one is unexplained. cuda: with a GPU, which has to give the same bits")
        ->type_name("embree|naive|sah|cuda");
}

void add_validation_flags(CLI::App& app, Options& options) {
    add_validate(app, options);
    app.add_option("--replay-file", options.replay_file,
                   "Where --validate writes unexplained rays for tools/bench --replay "
                   "[validate.replay]")
        ->type_name("FILE");
    app.add_flag("--replay-all", options.replay_all,
                 "Write explained disagreements too, up to 10000");
}

void add_integrator_flags(CLI::App& app, Options& options) {
    add_choice(app, "--estimator", options.estimator, estimator_names,
               "Direct light by light sampling, by BSDF sampling, or by both with multiple "
               "importance sampling [mis]");
    add_choice(app, "--hemisphere", options.hemisphere, hemisphere_names,
               "Diffuse bounces [cosine]");
    add_choice(app, "--light-sampling", options.light_sampling, light_names,
               "Points on lights, uniform in solid angle or in area [solid-angle]");
    app.add_option_function<std::string>(
           "--rr", [&options](const std::string& text) { parse_roulette(text, options); },
           "Russian roulette [throughput]")
        ->type_name("throughput|constant:P|none");
    add_count(app, "--rr-depth", options.rr_depth, 1, 1 << 30, "First depth that roulette may end");
    add_count(app, "--max-depth", options.max_depth, -1, 1 << 30,
              "Longest path in segments: 1 sees lights only, -1 has no limit");
    add_choice(app, "--reuse", options.reuse, reuse_names,
               "Pixels a side of blocks that share paths from the second vertex on [1: none]");
    add_choice(app, "--sampler", options.sampler, sampler_names, "Random numbers [the scene's]");
    add_count(app, "--spp", options.spp, 1, 0xffffffffll,
              "Samples per pixel, the bound with --target-error or --time-limit [the scene's; 2^24 "
              "with one of these]");
    add_stop_flags(app, options.stop);
    app.add_option_function<std::string>(
           "--seed",
           [&options](const std::string& text) {
               options.seed = parse_uint64(text);
               if (!options.seed)
                   throw CLI::ValidationError(
                       "--seed", fmt::format("bad seed (got '{}', expected 0 to 2^64-1)", text));
           },
           "Seed of all random numbers [0]")
        ->type_name("N");
}

void add_output_flags(CLI::App& app, Options& options) {
    app.add_option("-o,--output", options.outputs.files,
                   "Image file, repeatable: exr hdr tif pfm (scene-linear), png jpg ppm (display)")
        ->type_name("FILE")
        ->allow_extra_args(false);
    app.add_flag("--half", options.outputs.half, "EXR with 16-bit floats");
    app.add_option("--compression", options.outputs.compression, "EXR compression [zip]")
        ->type_name("none|rle|zips|zip|piz|pxr24|b44|b44a|dwaa|dwab");
    app.add_option("--view", options.outputs.view, "View of display files [sRGB]")
        ->type_name("NAME");
    app.add_option_function<std::string>(
           "--exposure",
           [&options](const std::string& text) {
               const auto stops = parse_float(text);
               if (!stops || !(*stops >= -100 && *stops <= 100))
                   throw CLI::ValidationError(
                       "--exposure",
                       fmt::format("bad number (got '{}', expected -100 to 100)", text));
               options.outputs.exposure = *stops;
           },
           "Exposure of display files")
        ->type_name("STOPS");
    app.add_option("--ocio", options.outputs.ocio_config,
                   "OpenColorIO configuration [$OCIO, else built in]")
        ->type_name("FILE");
    app.add_flag("--variance", options.variance, "Keep each pixel's variance in the EXR");
    app.add_option("--stats", options.stats_file, "Write what was measured as JSON")
        ->type_name("FILE");
    app.add_flag("--quiet,-q", options.quiet, "Print errors only");
}

/// An empty value is a slip (`-o "$unset"`): it must not count as a flag that was not given.
void check_no_value_is_empty(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options())
        for (const std::string& value : option->results())
            if (value.empty())
                throw CLI::ValidationError(option->get_name(), "empty value");
}

/// What CLI11 cannot see: flags that contradict each other.
void check_contradictions(const Options& options) {
    if (options.accel == AccelKind::embree &&
        options.build.triangle_test == TriangleTest::moeller_trumbore)
        throw CLI::ValidationError("--triangle-test",
                                   "moeller-trumbore needs --accel=naive or --accel=sah");
    if (options.device == Device::cuda && options.accel != AccelKind::sah)
        throw CLI::ValidationError("--device", "cuda needs --accel=sah");
    if (options.cuda.schedule == CudaSchedule::persistent && options.cuda.tree != CudaTree::wide)
        throw CLI::ValidationError("--cuda-schedule", "persistent needs --cuda-tree=wide");
    if (options.validate == options.accel)
        throw CLI::ValidationError("--validate", fmt::format("compares {} with itself: choose "
                                                             "another --accel or --validate",
                                                             name_of(options.accel)));
    if ((options.validate || options.validate_cuda) && options.device == Device::cuda)
        throw CLI::ValidationError("--validate", "needs --device=cpu");
    if (options.validate_cuda && options.accel == AccelKind::embree)
        throw CLI::ValidationError("--validate",
                                   "cuda has the bits of naive and sah, not Embree's");
    if (options.validate_cuda && options.stop.any())
        throw CLI::ValidationError("--validate", "cuda stops neither by error nor by time");
    if (!options.validate && (options.replay_all || !options.replay_file.empty()))
        throw CLI::ValidationError(options.replay_all ? "--replay-all" : "--replay-file",
                                   "needs --validate");
    check_stop_flags(options);
    if (options.reuse.value_or(1) > 1) {
        if (options.device == Device::cuda)
            throw CLI::ValidationError("--reuse", "needs --device=cpu");
        if (options.validate_cuda)
            throw CLI::ValidationError("--validate", "cuda shares no paths (--reuse)");
        if (options.stop.target_error > 0)
            throw CLI::ValidationError(
                "--reuse", "contradicts --target-error: pixels of a block need as many samples");
    }
    if (options.quiet && options.explain)
        throw CLI::ValidationError("--explain", "contradicts --quiet");
}

std::string join(int argc, const char* const* argv) {
    std::string line;
    for (int i = 0; i < argc; ++i)
        line += (i > 0 ? " " : "") + std::string(argv[i]);
    return line;
}

template <class T> void override_with(const std::optional<T>& value, T& target) {
    if (value)
        target = *value;
}

} // namespace

ParsedOptions parse_options(int argc, const char* const* argv) {
    CLI::App app{"Plumbline: a path tracer whose own BVHs stand beside Embree.", "renderer"};
    Options options;
    app.set_version_flag("--version", "plumbline " PLUMB_VERSION);
    app.footer(footer);
    add_scene_flags(app, options);
    add_output_flags(app, options);
    add_integrator_flags(app, options);
    add_speed_flags(app, options);
    add_validation_flags(app, options);
    app.allow_extras();
    try {
        app.parse(argc, argv);
        if (!app.remaining(true).empty())
            throw CLI::ValidationError("", unknown_argument(app));
        check_no_value_is_empty(app);
        check_contradictions(options);
    } catch (const CLI::Success& request) {
        std::ostringstream answer, none;
        const int code = app.exit(request, answer, none);
        return {std::nullopt, code, answer.str()};
    } catch (const CLI::ParseError& error) {
        const std::string unknown =
            app.remaining(true).empty() ? std::string() : unknown_argument(app);
        // What was typed may hold characters that a terminal obeys.
        const std::string what = one_line(unknown.empty() ? error.what() : unknown);
        return {std::nullopt, 2, fmt::format("error: {} (see --help)\n", what)};
    }
    options.command_line = join(argc, argv);
    return {options, 0, {}};
}

void apply_options(const Options& options, Scene& scene) {
    override_with(options.estimator, scene.path.estimator);
    override_with(options.hemisphere, scene.path.hemisphere);
    override_with(options.light_sampling, scene.path.light_sampling);
    override_with(options.roulette, scene.path.roulette);
    override_with(options.roulette_constant, scene.path.roulette_constant);
    override_with(options.rr_depth, scene.path.rr_depth);
    override_with(options.max_depth, scene.path.max_depth);
    override_with(options.reuse, scene.path.reuse);
    override_with(options.sampler, scene.sampler.kind);
    if (options.stop.any())
        scene.sampler.spp = spp_without_bound;
    override_with(options.spp, scene.sampler.spp);
    override_with(options.seed, scene.sampler.seed);
}

} // namespace plumb
