/// \file  A scene with a closed form, the methods that must reach it, and what a render gave.
///
/// Every pixel of an oracle's image is an independent sample of one number: mean, variance and the
/// largest sample are those of the estimator. Pixels have one sample, with the Sobol' sampler 16
/// that depend on each other. Where blocks of pixels share paths, it is their means that do not
/// depend on each other.
#pragma once

#include "tests/support/moments.h"
#include "tests/support/render_scene.h"

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

namespace plumb::test {

/// Probability to go on of the constant roulette: not 1/2, where a wrong probability hides.
inline constexpr float roulette_probability = 0.85f;
/// Longest path without roulette.
inline constexpr int depth_without_roulette = 6;
/// Samples of a pixel with the Sobol' sampler.
inline constexpr int sobol_samples = 16;

struct Method {
    Estimator estimator = Estimator::mis;
    HemisphereSampling hemisphere = HemisphereSampling::cosine;
    RouletteKind roulette = RouletteKind::throughput;
    LightSampling lights = LightSampling::solid_angle;
    SamplerKind sampler = SamplerKind::independent;
    int reuse = 1;

    /// As in "mis_cosine_throughput", "light_uniform_none_area_sobol" or "mis_cosine_none_reuse4".
    [[nodiscard]] std::string name() const;
    /// Roulette plays from the first bounce on; without it, paths are cut after
    /// depth_without_roulette segments.
    void apply(Scene& scene) const;
    [[nodiscard]] int samples_of_pixel() const {
        return sampler == SamplerKind::sobol ? sobol_samples : 1;
    }
    [[nodiscard]] int pixels_of_block() const { return reuse * reuse; }
};

/// Estimator x hemisphere x roulette, lights by solid angle, independent samples.
[[nodiscard]] std::vector<Method> all_methods();

struct Oracle {
    std::string name;
    std::string xml;         ///< made by scene_text
    double expected[3] = {}; ///< radiance seen by every pixel
    /// The same of paths of at most depth_without_roulette segments; equal where one bounce is all.
    double expected_cut[3] = {};
    /// The same of paths of at most two segments: no pixel shares that.
    double expected_alone[3] = {};
    /// Estimators that are run with light sampling by area too: where that has a variance that
    /// can be afforded.
    std::vector<Estimator> by_area;
    /// Light sampling alone has no bounded variance (a lamp that touches a wall): mean only.
    bool light_unbounded = false;
    SceneFileTexts files;
};

struct OracleRun {
    Oracle oracle;
    Method method;

    [[nodiscard]] std::string name() const { return oracle.name + "_" + method.name(); }
    [[nodiscard]] bool has_bounded_noise() const {
        return !(oracle.light_unbounded && method.estimator == Estimator::light);
    }
    [[nodiscard]] const double* expected() const {
        return method.roulette == RouletteKind::none ? oracle.expected_cut : oracle.expected;
    }
    /// Of the radiance, what comes from beyond the second vertices of paths.
    [[nodiscard]] double shared_part(int channel) const {
        return 1 - oracle.expected_alone[channel] / expected()[channel];
    }
};

/// All pairs of an oracle with its methods, for both samplers.
[[nodiscard]] std::vector<OracleRun> runs_of(const std::vector<Oracle>& oracles);
/// Pixels divided by what they should be: mean 1.
struct RelativeSamples {
    Moments channel[3];
    Moments block[3]; ///< means of the blocks that share paths; without, the pixels again
    int samples_of_pixel = 1, pixels_of_block = 1;

    /// Of one sample: that of a pixel times its samples. Largest of the channels.
    [[nodiscard]] double variance() const;
    /// The same for the mean of all: that of a block times its samples.
    [[nodiscard]] double block_variance(int channel) const;
    [[nodiscard]] double block_variance() const; ///< largest of the channels
    /// Of the pixels of the channel with the largest variance.
    [[nodiscard]] double kurtosis() const;
    [[nodiscard]] double max_over_mean() const; ///< largest of the channels
    /// Largest |z| of the three means against 1, from blocks. float arithmetic is granted 1e-5, so
    /// that estimators without noise have a finite z.
    [[nodiscard]] double largest_z() const;
    void merge(const RelativeSamples& other);
};

/// Renders at least `count` samples with the seeds from `seed` on. Throws what load_scene throws.
[[nodiscard]] RelativeSamples sample(const OracleRun& run, std::uint64_t count,
                                     std::uint64_t seed = 1);

void PrintTo(const OracleRun& run, std::ostream* out);

} // namespace plumb::test
