/// \file  Closed forms of radiance, rendered from scene files by every method.
///
/// Each run is held to three things: the mean (|z| <= 4.75 with so many samples that a bias of 1 %
/// is five standard errors), the variance (below its recorded ceiling) and the largest sample. A
/// mean alone is blind to roulette that divides by the wrong probability, to MIS weights that are
/// wrong but sum to one, and to every loss of sampling quality.
///
/// oracle_noise.txt holds what a correct estimator measures; tests/support/oracle_noise.h says how
/// the ceilings come about. After a change that is meant to alter them, make it anew (some
/// minutes):
///   tests/renderer/integrate/measure_oracle_noise.sh

#include "tests/support/oracle_noise.h"
#include "tests/support/oracle_scenes.h"
#include "tests/support/statistics.h"

#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <limits>
#include <map>

namespace plumb::test {
namespace {

/// Of the largest sample: it is a property of estimators whose samples are bounded (a light's
/// radiance over a pdf), but depends on the seeds where tails are long. 3: a camera ray in millions
/// meets the edge where perpendicular_squares touch and sees the lamp itself, 2.3 times the rest.
constexpr double max_margin = 3, longest_tail = 20;
constexpr std::uint64_t pilot_count = 1u << 16, test_seed = 1;
/// Of the recorded noise: other seeds than the tests'.
constexpr std::uint64_t repetitions = 4, first_recorded_seed = 1000;

/// Blocks of 2 x 2 and 4 x 4 pixels share paths: methods that differ in all, each where it is
/// cheap. Of one bounce nothing is shared; a lamp that is sampled and met, and the sky.
std::vector<OracleRun> sharing_runs() {
    const auto cosine = HemisphereSampling::cosine, uniform = HemisphereSampling::uniform;
    const Method mis{Estimator::mis, cosine, RouletteKind::none};
    const Method mis_uniform{Estimator::mis, uniform, RouletteKind::throughput};
    const Method bsdf{Estimator::bsdf, uniform, RouletteKind::none};
    const Method light{Estimator::light, cosine, RouletteKind::constant};
    const Method sobol{Estimator::mis, cosine, RouletteKind::throughput, LightSampling::solid_angle,
                       SamplerKind::sobol};
    const std::map<std::string, std::vector<Method>> methods{
        {"box_furnace", {mis, sobol}},
        {"rectangle_furnace", {mis}},
        {"sphere_furnace", {mis, bsdf}},
        {"point_in_sphere", {mis_uniform, bsdf, light, sobol}},
        {"cavity", {mis}},
        {"sphere_light", {mis, bsdf}},
        {"cube_under_sky", {mis_uniform, light}}};
    std::vector<OracleRun> runs;
    for (const auto& oracles : {enclosed_oracles(), sky_oracles(), round_light_oracles()})
        for (const Oracle& oracle : oracles)
            if (const auto found = methods.find(oracle.name); found != methods.end())
                for (Method method : found->second)
                    for (const int reuse : {2, 4}) {
                        method.reuse = reuse;
                        runs.push_back({oracle, method});
                    }
    return runs;
}

std::vector<OracleRun> all_runs() {
    std::vector<OracleRun> all = sharing_runs();
    for (const auto& oracles :
         {enclosed_oracles(), sky_oracles(), round_light_oracles(), polygon_oracles()}) {
        const std::vector<OracleRun> runs = runs_of(oracles);
        all.insert(all.end(), runs.begin(), runs.end());
    }
    return all;
}

class OracleImage : public ::testing::TestWithParam<OracleRun> {
  protected:
    static const std::map<std::string, OracleNoise>& table() {
        static const auto all =
            read_oracle_noise(PLUMB_SOURCE_DIR "/tests/renderer/integrate/oracle_noise.txt");
        return all;
    }
    static bool measuring() { return std::getenv("PLUMB_ORACLE_NOISE") != nullptr; }

    static void measure() {
        const OracleRun& run = GetParam();
        const RelativeSamples pilot = sample(run, pilot_count, first_recorded_seed);
        const std::uint64_t count = samples_for(run, pilot);
        std::vector<RelativeSamples> all;
        for (std::uint64_t i = 1; i <= repetitions; ++i)
            all.push_back(sample(run, count, (i + 1) * first_recorded_seed));
        OracleNoise noise = noise_of(all, count);
        if (!run.has_bounded_noise())
            noise.ceiling = std::numeric_limits<double>::infinity();
        fmt::print("noise {} {}\n", run.name(), line_of(noise));
        for (const RelativeSamples& s : all)
            EXPECT_LE(std::fabs(s.largest_z()), z_limit);
    }
};

TEST_P(OracleImage, MatchesTheClosedFormWithBoundedNoise) {
    if (measuring()) {
        measure();
        return;
    }
    const auto recorded = table().find(GetParam().name());
    ASSERT_NE(recorded, table().end()) << "no recorded variance: see the head of this file";
    const OracleNoise& noise = recorded->second;
    const RelativeSamples s = sample(GetParam(), noise.samples, test_seed);
    RecordProperty("z", fmt::format("{:.3f}", s.largest_z()));
    RecordProperty("variance", fmt::format("{:.4g}", s.variance()));
    EXPECT_LE(std::fabs(s.largest_z()), z_limit)
        << "mean / expected: " << s.channel[0].mean() << ' ' << s.channel[1].mean() << ' '
        << s.channel[2].mean() << " of " << s.channel[0].count() << " pixels";
    EXPECT_LE(s.variance(), noise.ceiling) << "recorded: " << noise.variance;
    if (GetParam().has_bounded_noise() && noise.kurtosis <= longest_tail) {
        EXPECT_LE(s.max_over_mean(), max_margin * noise.max_over_mean);
    }
}

/// A row that no run reads would look like a check.
TEST(OracleNoise, TheTableHoldsEveryRunAndNothingElse) {
    if (std::getenv("PLUMB_ORACLE_NOISE") != nullptr)
        GTEST_SKIP() << "the table is being made";
    const auto table =
        read_oracle_noise(PLUMB_SOURCE_DIR "/tests/renderer/integrate/oracle_noise.txt");
    std::size_t runs = 0, see_a_fifth = 0, bounded = 0;
    for (const OracleRun& run : all_runs()) {
        ++runs;
        const auto row = table.find(run.name());
        ASSERT_NE(row, table.end()) << run.name();
        EXPECT_EQ(std::isfinite(row->second.ceiling), run.has_bounded_noise()) << run.name();
        bounded += run.has_bounded_noise() ? 1u : 0u;
        see_a_fifth += row->second.ceiling <= 1.2 * row->second.variance + 1e-8 ? 1u : 0u;
    }
    EXPECT_EQ(runs, table.size());
    EXPECT_GE(static_cast<double>(see_a_fifth), 0.95 * static_cast<double>(bounded))
        << "a loss of a fifth is to be seen nearly everywhere";
}

std::string name_of_run(const ::testing::TestParamInfo<OracleRun>& info) {
    return info.param.name();
}

INSTANTIATE_TEST_SUITE_P(Enclosed, OracleImage, ::testing::ValuesIn(runs_of(enclosed_oracles())),
                         name_of_run);
INSTANTIATE_TEST_SUITE_P(Sky, OracleImage, ::testing::ValuesIn(runs_of(sky_oracles())),
                         name_of_run);
INSTANTIATE_TEST_SUITE_P(RoundLight, OracleImage,
                         ::testing::ValuesIn(runs_of(round_light_oracles())), name_of_run);
INSTANTIATE_TEST_SUITE_P(Polygon, OracleImage, ::testing::ValuesIn(runs_of(polygon_oracles())),
                         name_of_run);
INSTANTIATE_TEST_SUITE_P(Sharing, OracleImage, ::testing::ValuesIn(sharing_runs()), name_of_run);

} // namespace
} // namespace plumb::test
