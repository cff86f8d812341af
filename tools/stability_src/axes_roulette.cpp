/// \file  Axis of Russian roulette: how much the brightness of a furnace varies.
#include "renderer/integrate/path_steps.h"
#include "tools/stability_src/axis.h"
#include "tools/stability_src/random.h"

namespace plumb::stability {
namespace {

/// One path in a closed furnace whose walls emit 1: each of its vertices adds the throughput.
double path(const PathSteps<box_profile>& steps, float albedo, Random& random) {
    Rgb throughput{1, 1, 1};
    double sum = 1;
    for (int depth = 1;; ++depth) {
        throughput *= albedo;
        if (!steps.survives(throughput, depth, random.uniform()))
            return sum;
        sum += static_cast<double>(throughput.r);
    }
}

Outcome relative_sigma(const Trial& trial, RouletteKind kind, float constant) {
    const SceneView scene;
    PathSettings settings;
    settings.roulette = kind;
    settings.roulette_constant = constant;
    settings.rr_depth = 1; // the rule alone, from the first bounce
    const PathSteps<box_profile> steps(scene, settings);
    Random random(trial.seed);
    double mean = 0, squares = 0;
    for (std::size_t i = 0; i < trial.count; ++i) {
        const double x = path(steps, static_cast<float>(trial.stress), random), before = mean;
        mean += (x - mean) / static_cast<double>(i + 1);
        squares += (x - before) * (x - mean);
    }
    return {trial.count, 0, std::sqrt(squares / static_cast<double>(trial.count)) / mean};
}

} // namespace

void add_roulette_axis(std::vector<Axis>& axes) {
    Axis axis;
    axis.name = "roulette";
    axis.group = "sampling";
    axis.title = "Russian roulette in bright rooms";
    axis.unit = "albedo of all walls";
    axis.tested = "paths in a closed furnace, roulette from the first bounce";
    axis.failure = "value: standard deviation of the radiance of one path, over its mean";
    axis.range = "at most 1.05 from 0.1 to 0.95; the variance is unbounded where albedo^2 >= the "
                 "largest probability to go on: 0.95, so albedo 0.975";
    axis.value = "relative standard deviation";
    axis.stresses = {0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.97, 0.98, 0.99};
    axis.trials = 1000000;
    axis.quick_trials = 30000;
    axis.methods = {{"rr-constant-0.5", "goes on with probability 0.5"},
                    {"rr-constant-0.9", "goes on with probability 0.9"},
                    {"rr-throughput", "with the throughput, at most 0.95", true, 1.05, 0.1, 0.95}};
    axis.run = [](const Trial& trial) {
        return std::vector<Outcome>{relative_sigma(trial, RouletteKind::constant, 0.5f),
                                    relative_sigma(trial, RouletteKind::constant, 0.9f),
                                    relative_sigma(trial, RouletteKind::throughput, 0)};
    };
    axes.push_back(std::move(axis));
}

} // namespace plumb::stability
