/// \file  Axes of light sampling: how much an estimate of irradiance varies near a light.
#include "renderer/sampling/light_sampling.h"
#include "renderer/shading/bsdf.h"
#include "tools/stability_src/axis.h"
#include "tools/stability_src/random.h"

namespace plumb::stability {
namespace {

/// Standard deviation over mean of cos / pdf at a receiver at the origin that faces +z.
double relative_sigma(const Light& light, LightSampling method, const Trial& trial) {
    Random random(trial.seed);
    double mean = 0, squares = 0;
    for (std::size_t i = 0; i < trial.count; ++i) {
        const LightSample s =
            sample_light<full_profile>(light, {{0, 0, 0}, {0, 0, 1}}, random.square(), method);
        const double x = s.pdf > 0 && s.wi.z > 0
                             ? static_cast<double>(s.wi.z) / static_cast<double>(s.pdf)
                             : 0.0;
        const double before = mean;
        mean += (x - mean) / static_cast<double>(i + 1);
        squares += (x - before) * (x - mean);
    }
    return std::sqrt(squares / static_cast<double>(trial.count)) / mean;
}

std::vector<Outcome> both(const Light& light, const Trial& trial) {
    std::vector<Outcome> outcomes;
    for (const LightSampling method : {LightSampling::area, LightSampling::solid_angle})
        outcomes.push_back({trial.count, 0, relative_sigma(light, method, trial)});
    return outcomes;
}

/// A square of 1 above the receiver, facing down.
Light square_light(double height) {
    Light light;
    light.kind = LightKind::rectangle;
    light.emission = {1, 1, 1};
    light.origin = {-0.5f, -0.5f, static_cast<float>(height)};
    light.edge1 = {0, 1, 0};
    light.edge2 = {1, 0, 0};
    light.normal = {0, 0, -1};
    light.area = 1;
    light.probability = 1;
    return light;
}

Light sphere_light(double ratio) {
    Light light;
    light.kind = LightKind::sphere;
    light.emission = {1, 1, 1};
    light.radius = 0.7f;
    light.origin = {0, 0, static_cast<float>(ratio * 0.7)};
    light.area = 4 * pi * light.radius * light.radius;
    light.probability = 1;
    return light;
}

Axis light_axis(std::string name, std::string title, std::string unit,
                std::function<Light(double)> light) {
    Axis axis;
    axis.name = std::move(name);
    axis.group = "sampling";
    axis.title = std::move(title);
    axis.unit = std::move(unit);
    axis.failure = "value: standard deviation of the estimate from one sample, over its mean";
    axis.value = "relative standard deviation";
    axis.trials = 1000000;
    axis.quick_trials = 50000;
    // Uniform over a hemisphere is the worst case of uniform solid angles: 1/sqrt(3).
    axis.methods = {{"light-by-area", "uniform over the light's area"},
                    {"light-by-angle", "uniform over its solid angle", true, 0.62}};
    axis.run = [light](const Trial& trial) { return both(light(trial.stress), trial); };
    return axis;
}

/// A round light overhead, found by directions of the BSDF: variance over that of the cosine, which
/// finds it with the probability sin^2 of its half angle and brings 1 each time.
double hemisphere_variance(HemisphereSampling hemisphere, const Trial& trial) {
    Random random(trial.seed);
    const Material white{MaterialKind::diffuse, {1, 1, 1}};
    const double angle = trial.stress * pi_double / 180;
    const double mean = std::sin(angle) * std::sin(angle);
    const auto edge = static_cast<float>(std::cos(angle));
    double squares = 0;
    for (std::size_t i = 0; i < trial.count; ++i) {
        const BsdfSample s = sample_bsdf(white, {0, 0, 1}, random.square(), hemisphere);
        const double x = s.pdf > 0 && s.wi.z > edge ? static_cast<double>(s.weight.r) : 0.0;
        squares += (x - mean) * (x - mean);
    }
    return squares / static_cast<double>(trial.count) / (mean * (1 - mean));
}

Axis hemisphere_axis() {
    Axis axis;
    axis.name = "hemisphere";
    axis.group = "sampling";
    axis.title = "Directions of a diffuse surface";
    axis.unit = "half angle of a round light overhead in degrees";
    axis.tested = "light found by directions of a white diffuse surface";
    axis.failure = "value: variance of one direction, over what the cosine distribution has";
    axis.range = "at most 1.1 from 10 to 80 degrees";
    axis.value = "variance / that of the cosine";
    axis.stresses = {10, 20, 30, 40, 50, 60, 70, 80};
    axis.trials = 1000000;
    axis.quick_trials = 100000;
    axis.methods = {{"uniform", "uniform over the hemisphere"},
                    {"cosine", "by the cosine", true, 1.1}};
    axis.run = [](const Trial& trial) {
        std::vector<Outcome> outcomes;
        for (const HemisphereSampling h : {HemisphereSampling::uniform, HemisphereSampling::cosine})
            outcomes.push_back({trial.count, 0, hemisphere_variance(h, trial)});
        return outcomes;
    };
    return axis;
}

} // namespace

void add_light_axes(std::vector<Axis>& axes) {
    axes.push_back(light_axis("light-height", "Close to a square light",
                              "side of the light / distance",
                              [](double closeness) { return square_light(1 / closeness); }));
    axes.back().tested = "irradiance of a point under the middle of a square light";
    axes.back().range = "at most 0.62 from 1e-2 to 1e4 (uniform over a hemisphere: 0.577)";
    axes.back().stresses = powers_of_ten(-2, 4);

    axes.push_back(light_axis("light-sphere", "Close to a sphere light",
                              "radius / (distance of the centre - radius)",
                              [](double closeness) { return sphere_light(1 + 1 / closeness); }));
    axes.back().tested = "irradiance of a point that faces the centre of a sphere light";
    axes.back().range = "at most 0.62 from 1e-2 to 1e4 (uniform over a hemisphere: 0.577)";
    axes.back().stresses = powers_of_ten(-2, 4);

    axes.push_back(hemisphere_axis());
}

} // namespace plumb::stability
