/// \file  Axes of the accumulators: sums of many samples, variances of bright ones.
#include "renderer/integrate/film.h"
#include "tools/stability_src/alternatives/sums.h"
#include "tools/stability_src/axis.h"
#include "tools/stability_src/random.h"

#include <algorithm>

namespace plumb::stability {
namespace {

std::vector<Outcome> sums(const Trial& trial) {
    Random random(trial.seed);
    FloatSum plain;
    KahanSum kahan;
    FilmPixel film;
    long double exact = 0; // 2^-64 a step: 1e-15 of the sum of 1e8 random roundings
    const auto n = static_cast<std::size_t>(trial.stress);
    for (std::size_t i = 0; i < n; ++i) {
        const float u = random.uniform(), x = u * u;
        plain.add(x);
        kahan.add(x);
        film.add({x, 0, 0}, false);
        exact += static_cast<long double>(x);
    }
    std::vector<Outcome> outcomes;
    for (const double sum :
         {static_cast<double>(plain.sum), static_cast<double>(kahan.sum), film.sum[0]})
        outcomes.push_back(
            {n, 0, static_cast<double>(std::fabs(static_cast<long double>(sum) / exact - 1))});
    return outcomes;
}

std::vector<Outcome> variances(const Trial& trial) {
    Random random(trial.seed);
    const auto mean = static_cast<float>(trial.stress);
    std::vector<float> samples(trial.count);
    for (float& x : samples)
        x = mean + random.uniform();
    MomentVariance<float> in_float;
    MomentVariance<double> in_double;
    FilmPixel film;
    long double center = 0, squares = 0;
    for (const float x : samples) {
        in_float.add(x);
        in_double.add(x);
        film.add({x, 0, 0}, true);
        center += static_cast<long double>(x);
    }
    const auto n = static_cast<long double>(samples.size());
    for (const float x : samples) {
        const long double d = static_cast<long double>(x) - center / n;
        squares += d * d;
    }
    std::vector<Outcome> outcomes;
    for (const double variance : {in_float.variance(), in_double.variance(),
                                  film.m2[0] / static_cast<double>(samples.size())})
        outcomes.push_back({trial.count, 0,
                            static_cast<double>(std::fabs(
                                static_cast<long double>(variance) / (squares / n) - 1))});
    return outcomes;
}

} // namespace

void add_sum_axes(std::vector<Axis>& axes) {
    Axis sum;
    sum.name = "sum";
    sum.group = "sums";
    sum.title = "Sums of many samples";
    sum.unit = "samples";
    sum.tested = "the sum of squares of random numbers";
    sum.failure = "value: relative error of the sum";
    sum.range = "at most 1e-12 from 100 to 1e8";
    sum.value = "relative error";
    sum.stresses = powers_of_ten(2, 8);
    sum.quick_to = 1e6;
    sum.trials = sum.quick_trials = 1;
    sum.methods = {{"float", "a float"},
                   {"kahan-float", "a float with Kahan's correction"},
                   {"film", "the film of this project, in double", true, 1e-12}};
    sum.run = sums;
    axes.push_back(std::move(sum));

    Axis variance;
    variance.name = "variance";
    variance.group = "sums";
    variance.title = "Variance of bright samples";
    variance.unit = "mean; the variance is 1/12";
    variance.tested = "the variance of samples between mean and mean + 1";
    variance.failure = "value: relative error of the variance";
    variance.range = "at most 1 % from 1 to 1e6";
    variance.value = "relative error";
    variance.stresses = powers_of_ten(0, 6);
    variance.trials = 1000000;
    variance.quick_trials = 20000;
    variance.methods = {{"moments-float", "E[x^2] - E[x]^2 in float"},
                        {"moments-double", "the same in double"},
                        {"film", "the film of this project, Welford in double", true, 0.01}};
    variance.run = variances;
    axes.push_back(std::move(variance));
}

} // namespace plumb::stability
