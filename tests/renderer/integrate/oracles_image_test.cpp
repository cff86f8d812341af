/// \file  Closed forms of radiance, rendered from scene files by every method.
///
/// Each run is held to three things: the mean (|z| <= 4.75 with so many samples that a bias of 1 %
/// is five standard errors), the variance (1.2 x the stored one) and the largest sample. A mean
/// alone is blind to roulette that divides by the wrong probability and to MIS weights that are
/// wrong but sum to one.
///
/// oracle_bounds.txt holds what a correct estimator measures: name, relative variance, max/mean.
/// After a change that is meant to alter them, make it anew:
///   PLUMB_ORACLE_BOUNDS=measure renderer_integrate_image_tests --gtest_filter='*Oracle*'
///     | sed -n 's/^bound //p' > tests/renderer/integrate/oracle_bounds.txt

#include "tests/support/oracle_scenes.h"

#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace plumb::test {
namespace {

constexpr double variance_margin = 1.2, max_margin = 1.5;
constexpr std::uint64_t min_count = 4096, pilot_count = 1u << 16;

/// So many samples that 1 % is five standard errors.
std::uint64_t count_for(double relative_variance) {
    return std::max(min_count, static_cast<std::uint64_t>(std::ceil(2.5e5 * relative_variance)));
}

class OracleImage : public ::testing::TestWithParam<OracleRun> {
  protected:
    static const std::map<std::string, OracleBound>& bounds() {
        static const auto all =
            read_oracle_bounds(PLUMB_SOURCE_DIR "/tests/renderer/integrate/oracle_bounds.txt");
        return all;
    }
    static bool measuring() { return std::getenv("PLUMB_ORACLE_BOUNDS") != nullptr; }

    static void measure() {
        const double pilot = sample(GetParam(), pilot_count).variance();
        const RelativeSamples s = sample(GetParam(), count_for(pilot));
        fmt::print("bound {} {:.4g} {:.4g}\n", GetParam().name(), s.variance(), s.max_over_mean());
        EXPECT_LE(std::fabs(s.largest_z()), z_limit);
    }
};

TEST_P(OracleImage, MatchesTheClosedFormWithBoundedNoise) {
    if (measuring()) {
        measure();
        return;
    }
    const auto bound = bounds().find(GetParam().name());
    ASSERT_NE(bound, bounds().end()) << "no stored variance: see the head of this file";
    const auto& [variance, max_over_mean] = bound->second;
    const RelativeSamples s = sample(GetParam(), count_for(variance));
    RecordProperty("z", fmt::format("{:.3f}", s.largest_z()));
    EXPECT_LE(std::fabs(s.largest_z()), z_limit)
        << "mean / expected: " << s.channel[0].mean() << ' ' << s.channel[1].mean() << ' '
        << s.channel[2].mean() << " of " << s.channel[0].count() << " samples";
    if (!GetParam().has_bounded_noise())
        return;
    // Estimators without noise are allowed that of float sums.
    EXPECT_LE(s.variance(), variance_margin * variance + 1e-9);
    EXPECT_LE(s.max_over_mean(), max_margin * max_over_mean);
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

} // namespace
} // namespace plumb::test
