#include "tests/support/oracle_noise.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace plumb::test {
namespace {

constexpr double sigmas = 4.9;
/// What float sums add where the estimator has no noise.
constexpr double rounding = 1e-9;
constexpr std::uint64_t fewest = 1u << 15, fewest_sobol = 1u << 16, most_for_variance = 1u << 19;

/// Of `count` blocks of test pixels against `repetitions` x as many recorded ones.
double spread_of(std::span<const RelativeSamples> repetitions, double kurtosis, double count) {
    const auto times = static_cast<double>(repetitions.size());
    const double from_kurtosis = relative_error_of_variance(kurtosis, count);
    Moments variances;
    for (const RelativeSamples& s : repetitions)
        variances.add(s.variance());
    const double seen = std::sqrt(variances.variance()) / variances.mean();
    const double one = seen > 2 * from_kurtosis ? seen : from_kurtosis;
    return one * std::sqrt(1 + 1 / times);
}

} // namespace

std::string line_of(const OracleNoise& n) {
    return fmt::format("{} {:.4g} {:.4g} {:.4g} {:.4g}", n.samples, n.variance, n.kurtosis,
                       n.ceiling, n.max_over_mean);
}

std::map<std::string, OracleNoise> read_oracle_noise(const std::string& file) {
    std::ifstream in(file);
    std::map<std::string, OracleNoise> table;
    std::string line;
    while (std::getline(in, line)) {
        if (line.empty() || line[0] == '#')
            continue;
        std::istringstream words(line);
        std::string name, ceiling;
        OracleNoise n;
        if (!(words >> name >> n.samples >> n.variance >> n.kurtosis >> ceiling >> n.max_over_mean))
            throw std::runtime_error(file + ": not understood: " + line);
        n.ceiling = ceiling == "inf" ? std::numeric_limits<double>::infinity() : std::stod(ceiling);
        if (!table.emplace(name, n).second)
            throw std::runtime_error(file + ": twice: " + name);
    }
    if (table.empty())
        throw std::runtime_error(file + ": nothing to read");
    return table;
}

std::uint64_t samples_for(const OracleRun& run, const RelativeSamples& pilot) {
    const auto count = [](double n) { return static_cast<std::uint64_t>(std::ceil(n)); };
    double for_mean = pilot.block_variance();
    if (run.method.reuse > 1) {
        double for_shared = std::numeric_limits<double>::infinity();
        for (int c = 0; c < 3; ++c)
            if (const double part = run.shared_part(c); part > 1e-6)
                for_shared = std::min(for_shared, pilot.block_variance(c) / (part * part));
        if (std::isfinite(for_shared))
            for_mean = std::max(for_mean, for_shared);
    }
    const int samples_of_block = pilot.samples_of_pixel * pilot.pixels_of_block;
    const std::uint64_t for_variance =
        std::min(most_for_variance, count(2000 * (pilot.kurtosis() - 1) * samples_of_block));
    return std::max(
        {count(2.5e5 * for_mean), for_variance, samples_of_block > 1 ? fewest_sobol : fewest});
}

OracleNoise noise_of(std::span<const RelativeSamples> repetitions, std::uint64_t samples) {
    RelativeSamples all = repetitions[0];
    for (const RelativeSamples& s : repetitions.subspan(1))
        all.merge(s);
    OracleNoise noise;
    noise.samples = samples;
    noise.variance = all.variance();
    noise.kurtosis = all.kurtosis();
    noise.max_over_mean = all.max_over_mean();
    const double s = noise.variance > rounding
                         ? spread_of(repetitions, noise.kurtosis,
                                     static_cast<double>(repetitions[0].block[0].count()))
                         : 0;
    noise.ceiling = noise.variance * std::exp(sigmas * std::sqrt(std::log1p(s * s))) + rounding;
    return noise;
}

} // namespace plumb::test
