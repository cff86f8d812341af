/// \file  Axes of warps and frames: cones, points on triangles, bases around a normal.
#include "accel/math/frame.h"
#include "renderer/sampling/warp.h"
#include "tools/stability_src/alternatives/frames.h"
#include "tools/stability_src/alternatives/sums.h"
#include "tools/stability_src/axis.h"
#include "tools/stability_src/random.h"

#include <algorithm>
#include <array>
#include <limits>

namespace plumb::stability {
namespace {

/// Relative errors of 1 - cos of the cone around a sphere, the worst of all.
std::vector<Outcome> cones(const Trial& trial) {
    std::vector<Outcome> outcomes(2, {trial.count, 0, 0.0});
    Random random(trial.seed);
    for (std::size_t i = 0; i < trial.count; ++i) {
        const float radius = random.uniform(0.1f, 1);
        const auto distance = static_cast<float>(static_cast<double>(radius) * trial.stress *
                                                 (1 + 0.5 * uniform_double(random)));
        const long double s = static_cast<long double>(radius) / distance;
        const long double truth = s * s / (1 + std::sqrt(1 - s * s));
        const float sin2 = radius * radius / (distance * distance);
        const std::array got{one_minus_cos_direct(sin2), one_minus_cos(sin2)};
        for (std::size_t k = 0; k < got.size(); ++k) {
            // Of the pdf, 1 / (2 pi (1 - cos)): infinite where that is 0.
            const double error = static_cast<double>(std::fabs(truth / got[k] - 1));
            outcomes[k].value = std::max(*outcomes[k].value, error);
        }
    }
    return outcomes;
}

double dot_double(Vec3 a, Vec3 b) {
    return static_cast<double>(a.x) * static_cast<double>(b.x) +
           static_cast<double>(a.y) * static_cast<double>(b.y) +
           static_cast<double>(a.z) * static_cast<double>(b.z);
}

/// Largest deviation of s, t, n from orthonormal; infinite for NaN.
double defect(Vec3 s, Vec3 t, Vec3 n) {
    double worst = 0;
    for (const double d : {dot_double(s, s) - 1, dot_double(t, t) - 1, dot_double(s, t),
                           dot_double(s, n), dot_double(t, n)})
        worst =
            std::isnan(d) ? std::numeric_limits<double>::infinity() : std::max(worst, std::fabs(d));
    return worst;
}

std::vector<Outcome> frames(const Trial& trial) {
    std::vector<Outcome> outcomes(3, {trial.count, 0, 0.0});
    Random random(trial.seed);
    for (std::size_t i = 0; i < trial.count; ++i) {
        const double angle = (0.5 + uniform_double(random)) / trial.stress;
        const double phi = 2 * pi_double * uniform_double(random), sine = std::sin(angle);
        const Vec3 n{static_cast<float>(sine * std::cos(phi)),
                     static_cast<float>(sine * std::sin(phi)),
                     static_cast<float>(-std::cos(angle))};
        const Basis axis = frame_from_axis(n), frisvad = frame_of_frisvad(n);
        const Frame own(n);
        const std::array defects{defect(axis.s, axis.t, n), defect(frisvad.s, frisvad.t, n),
                                 defect(own.s, own.t, n)};
        for (std::size_t k = 0; k < defects.size(); ++k)
            outcomes[k].value = std::max(*outcomes[k].value, defects[k]);
    }
    return outcomes;
}

/// Pearson's chi² over its degrees of freedom, of 16 x 16 parts of the triangle of equal area.
std::vector<Outcome> triangle_points(const Trial& trial) {
    constexpr std::size_t side = 16, bins = side * side;
    using Warp = Vec2 (*)(Vec2);
    std::vector<Outcome> outcomes;
    for (const Warp warp : {Warp(sample_triangle_without_root), Warp(sample_triangle)}) {
        Random random(trial.seed);
        std::array<double, bins> counts{};
        const auto n = static_cast<std::size_t>(trial.stress);
        for (std::size_t i = 0; i < n; ++i) {
            const Vec2 b = warp(random.square());
            const float sum = b.x + b.y;
            const auto cell = [](float x) {
                return std::min(side - 1, static_cast<std::size_t>(x * side));
            };
            ++counts[cell(sum * sum) * side + cell(sum > 0 ? b.y / sum : 0)];
        }
        const double expected = static_cast<double>(n) / static_cast<double>(bins);
        double chi2 = 0;
        for (const double count : counts)
            chi2 += (count - expected) * (count - expected) / expected;
        outcomes.push_back({n, 0, chi2 / (bins - 1)});
    }
    return outcomes;
}

} // namespace

void add_direction_axes(std::vector<Axis>& axes) {
    Axis cone;
    cone.name = "cone";
    cone.group = "sampling";
    cone.title = "The pdf of a far sphere light";
    cone.unit = "distance / radius, up to 1.5 times that";
    cone.tested = "1 - cos of the half angle of the cone around a sphere";
    cone.failure = "value: relative error of the pdf, the worst of all";
    cone.range = "at most 1e-5 from 1.001 to 1e6";
    cone.value = "worst relative error";
    cone.stresses = powers_of_ten(0, 6);
    cone.stresses.front() = 1.001;
    cone.trials = 1000000;
    cone.quick_trials = 20000;
    cone.methods = {{"1-cos", "1 - sqrt(1 - sin^2) in float"},
                    {"series", "sin^2 / (1 + sqrt(1 - sin^2)), this project's", true, 1e-5}};
    cone.run = cones;
    axes.push_back(std::move(cone));

    Axis points;
    points.name = "triangle-points";
    points.group = "sampling";
    points.title = "Points on a triangle";
    points.unit = "samples";
    points.tested = "points of a triangle from pairs of random numbers";
    points.failure = "value: chi^2 over its 255 degrees of freedom, about 1 for uniform points";
    points.range = "at most 1.5 for any number (5.6 standard deviations)";
    points.value = "chi^2 / degrees of freedom";
    points.stresses = powers_of_ten(4, 7);
    points.quick_to = 1e5;
    points.trials = points.quick_trials = 1;
    points.methods = {{"no-root", "barycentrics without the square root"},
                      {"root", "with it, this project's", true, 1.5}};
    points.run = triangle_points;
    axes.push_back(std::move(points));

    Axis frame;
    frame.name = "frame";
    frame.group = "frames";
    frame.title = "Normals close to -z";
    frame.unit = "1 / angle to the -z axis in radians";
    frame.tested = "two tangents of random normals at 0.5 to 1.5 times that angle";
    frame.failure = "value: deviation from orthonormal, the worst of all; NaN counts as infinite";
    frame.range = "at most 5e-7 at any angle";
    frame.value = "worst deviation";
    frame.stresses = powers_of_ten(0, 8);
    frame.stresses.push_back(1e16);
    frame.stresses.push_back(1e24);
    frame.trials = 1000000;
    frame.quick_trials = 20000;
    frame.methods = {{"fixed-axis", "cross product with the z axis"},
                     {"frisvad", "Frisvad 2012"},
                     {"duff", "Duff et al. 2017, this project's", true, 5e-7}};
    frame.run = frames;
    axes.push_back(std::move(frame));
}

} // namespace plumb::stability
