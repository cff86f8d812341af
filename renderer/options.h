/// \file  The command line of the renderer.
#pragma once

#include "accel/intersector.h"
#include "cuda/device_tree.h"
#include "renderer/integrate/stopping.h"
#include "renderer/io/load_scene.h"
#include "renderer/io/write_images.h"
#include "renderer/scene/scene.h"

#include <optional>

namespace plumb {

enum class Device : std::uint8_t { cpu, cuda, automatic };

/// What the user asked for. Empty optionals leave the scene's own value.
struct Options {
    LoadOptions scene;
    OutputOptions outputs;
    AccelKind accel = AccelKind::sah;
    BuildOptions build;
    Device device = Device::cpu;
    CudaSettings cuda;
    int threads = 0; ///< 0: all cores
    std::optional<Estimator> estimator;
    std::optional<HemisphereSampling> hemisphere;
    std::optional<LightSampling> light_sampling;
    std::optional<RouletteKind> roulette;
    std::optional<float> roulette_constant;
    std::optional<int> rr_depth, max_depth, reuse;
    std::optional<SamplerKind> sampler;
    std::optional<std::uint32_t> spp;
    std::optional<std::uint64_t> seed;
    StopSettings stop;
    bool variance = false;
    bool full_profile = false;
    bool explain = false;
    bool quiet = false;
    std::filesystem::path stats_file;
    std::optional<AccelKind> validate; ///< traces the render's rays as well
    bool validate_cuda = false;        ///< has a GPU do it, in place of `validate`
    std::filesystem::path replay_file; ///< empty: validate.replay, if needed
    bool replay_all = false;           ///< explained disagreements too
    std::string command_line;          ///< as typed, for the image's metadata
};

/// Either options, or the exit code of a run that ends here and what it prints: --help and
/// --version to stdout (0), a usage error of one line to stderr (2).
struct ParsedOptions {
    std::optional<Options> options;
    int exit_code = 0;
    std::string text;
};

[[nodiscard]] ParsedOptions parse_options(int argc, const char* const* argv);

/// Puts what the command line says over what the scene says. Where error or time end the render,
/// the bound on its samples is that of the command line or spp_without_bound, not the scene's.
void apply_options(const Options& options, Scene& scene);

} // namespace plumb
