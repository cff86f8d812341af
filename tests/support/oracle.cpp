#include "tests/support/oracle.h"

#include <algorithm>
#include <cmath>

namespace plumb::test {
namespace {

/// Largest film: its sums take 56 bytes a pixel.
constexpr std::uint64_t max_side = 1024;
/// Rounding of float sums, relative to the result.
constexpr double rounding = 1e-5;

const char* name_of(Estimator e) {
    return e == Estimator::mis ? "mis" : e == Estimator::light ? "light" : "bsdf";
}

const char* name_of(RouletteKind r) {
    return r == RouletteKind::none         ? "none"
           : r == RouletteKind::throughput ? "throughput"
                                           : "constant";
}

} // namespace

std::string Method::name() const {
    return std::string(name_of(estimator)) +
           (hemisphere == HemisphereSampling::cosine ? "_cosine_" : "_uniform_") +
           name_of(roulette) + (lights == LightSampling::area ? "_area" : "") +
           (sampler == SamplerKind::sobol ? "_sobol" : "") +
           (reuse > 1 ? "_reuse" + std::to_string(reuse) : "");
}

void Method::apply(Scene& scene) const {
    scene.path.estimator = estimator;
    scene.path.hemisphere = hemisphere;
    scene.path.light_sampling = lights;
    scene.path.roulette = roulette;
    scene.path.roulette_constant = roulette_probability;
    scene.path.rr_depth = 1;
    scene.path.max_depth = roulette == RouletteKind::none ? depth_without_roulette : -1;
    scene.path.reuse = reuse;
    scene.sampler.kind = sampler;
}

std::vector<Method> all_methods() {
    std::vector<Method> methods;
    for (const Estimator e : {Estimator::mis, Estimator::light, Estimator::bsdf})
        for (const auto h : {HemisphereSampling::cosine, HemisphereSampling::uniform})
            for (const auto r :
                 {RouletteKind::throughput, RouletteKind::constant, RouletteKind::none})
                methods.push_back({e, h, r, LightSampling::solid_angle, SamplerKind::independent});
    return methods;
}

std::vector<OracleRun> runs_of(const std::vector<Oracle>& oracles) {
    std::vector<OracleRun> runs;
    for (const Oracle& oracle : oracles)
        for (const auto sampler : {SamplerKind::independent, SamplerKind::sobol})
            for (Method method : all_methods()) {
                method.sampler = sampler;
                runs.push_back({oracle, method});
                const auto& by_area = oracle.by_area;
                if (std::find(by_area.begin(), by_area.end(), method.estimator) == by_area.end())
                    continue;
                method.lights = LightSampling::area;
                runs.push_back({oracle, method});
            }
    return runs;
}

double RelativeSamples::variance() const {
    return samples_of_pixel *
           std::max({channel[0].variance(), channel[1].variance(), channel[2].variance()});
}

double RelativeSamples::block_variance(int c) const {
    return samples_of_pixel * pixels_of_block * block[c].variance();
}

double RelativeSamples::block_variance() const {
    return std::max({block_variance(0), block_variance(1), block_variance(2)});
}

double RelativeSamples::kurtosis() const {
    return std::max_element(
               std::begin(channel), std::end(channel),
               [](const Moments& a, const Moments& b) { return a.variance() < b.variance(); })
        ->kurtosis();
}

void RelativeSamples::merge(const RelativeSamples& other) {
    for (int c = 0; c < 3; ++c) {
        channel[c].merge(other.channel[c]);
        block[c].merge(other.block[c]);
    }
}

double RelativeSamples::max_over_mean() const {
    double largest = 0;
    for (const Moments& c : channel)
        largest = std::fmax(largest, c.max_abs() / c.mean());
    return largest;
}

double RelativeSamples::largest_z() const {
    double largest = 0;
    for (const Moments& c : block) {
        const double z = (c.mean() - 1) / std::hypot(c.standard_error(), rounding);
        if (!(std::fabs(z) <= std::fabs(largest))) // NaN stays
            largest = z;
    }
    return largest;
}

namespace {

/// Blocks cover the image: its side is a multiple of theirs.
void add(const Image& image, const OracleRun& run, RelativeSamples& samples) {
    const int block = run.method.reuse;
    for (int y0 = 0; y0 < image.height; y0 += block)
        for (int x0 = 0; x0 < image.width; x0 += block) {
            double sum[3] = {};
            for (int i = 0; i < block * block; ++i) {
                const Rgb p = image.pixels[static_cast<std::size_t>((y0 + i / block) * image.width +
                                                                    x0 + i % block)];
                const float value[3] = {p.r, p.g, p.b};
                for (int c = 0; c < 3; ++c) {
                    const double relative = static_cast<double>(value[c]) / run.expected()[c];
                    samples.channel[c].add(relative);
                    sum[c] += relative;
                }
            }
            for (int c = 0; c < 3; ++c)
                samples.block[c].add(sum[c] / samples.pixels_of_block);
        }
}

} // namespace

RelativeSamples sample(const OracleRun& run, std::uint64_t count, std::uint64_t seed) {
    RelativeSamples samples;
    samples.samples_of_pixel = run.method.samples_of_pixel();
    samples.pixels_of_block = run.method.pixels_of_block();
    const auto block = static_cast<std::uint64_t>(run.method.reuse);
    const auto spp = static_cast<std::uint64_t>(samples.samples_of_pixel);
    for (; samples.channel[0].count() * spp < count; ++seed) {
        const auto missing = static_cast<double>(count) / static_cast<double>(spp) -
                             static_cast<double>(samples.channel[0].count());
        const auto enough = static_cast<std::uint64_t>(std::ceil(std::sqrt(missing)));
        const auto side = std::min(max_side, (enough + block - 1) / block * block);
        RenderSetup setup;
        setup.parameters = {{"side", std::to_string(side)},
                            {"spp", std::to_string(spp)},
                            {"seed", std::to_string(seed)}};
        setup.adjust = [&run](Scene& scene) { run.method.apply(scene); };
        add(render_xml(run.oracle.xml, setup, run.oracle.files).image, run, samples);
    }
    return samples;
}

void PrintTo(const OracleRun& run, std::ostream* out) { *out << run.name(); }

} // namespace plumb::test
