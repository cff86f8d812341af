/// \file  The machinery of tools/stability: intervals, judgement, sweep, JSON.

#include "tools/stability_src/interval.h"
#include "tools/stability_src/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace plumb::test {
namespace {

using namespace stability;

/// An axis of two stresses whose default fails `failures` times out of 1000 at the second.
Axis made_axis(std::uint64_t failures) {
    Axis axis;
    axis.name = "made";
    axis.group = "made";
    axis.title = axis.unit = axis.tested = axis.failure = axis.range = "text with \"quotes\"";
    axis.stresses = {1, 10};
    axis.trials = 1000;
    axis.quick_trials = 10;
    axis.methods = {{"bad", "it"}, {"good", "it", true, 0.0}};
    axis.run = [failures](const Trial& trial) {
        return std::vector<Outcome>{{trial.count, 1, {}},
                                    {trial.count, trial.stress > 5 ? failures : 0, {}}};
    };
    return axis;
}

TEST(WilsonInterval, GivesThePublishedBounds) {
    // 10 of 100: 0.0552 .. 0.1744; 0 of n: z^2 / (n + z^2).
    const RateInterval ten = wilson_interval(10, 100);
    EXPECT_NEAR(ten.low, 0.0552, 5e-5);
    EXPECT_NEAR(ten.high, 0.1744, 5e-5);
    const RateInterval none = wilson_interval(0, 1000);
    EXPECT_EQ(none.low, 0);
    EXPECT_NEAR(none.high, 3.841459 / 1003.841459, 1e-9);
    const RateInterval all = wilson_interval(1000, 1000);
    EXPECT_NEAR(all.low, 1000 / 1003.841459, 1e-9);
    EXPECT_EQ(all.high, 1);
    EXPECT_EQ(wilson_interval(0, 0).high, 1);
}

TEST(StabilityAxis, JudgesOnlyWithinTheRange) {
    Axis axis = made_axis(0);
    axis.methods[1].from = 2;
    axis.methods[1].to = 20;
    const Outcome failed{100, 1, {}};
    EXPECT_FALSE(axis.violated(1, 1.9, failed));
    EXPECT_TRUE(axis.violated(1, 2, failed));
    EXPECT_TRUE(axis.violated(1, 20, failed));
    EXPECT_FALSE(axis.violated(1, 21, failed));
    EXPECT_FALSE(axis.violated(1, 10, {100, 0, {}}));
    EXPECT_FALSE(axis.violated(0, 10, failed)) << "a method without a limit";
    EXPECT_TRUE(axis.violated(1, 10, {0, 0, {}})) << "nothing was tried";
}

TEST(StabilityAxis, TakesWhatIsNoNumberAsInfinite) {
    Axis axis = made_axis(0);
    axis.value = "error";
    axis.methods[1].limit = 0.5;
    EXPECT_FALSE(axis.violated(1, 1, {1, 0, 0.5}));
    EXPECT_TRUE(axis.violated(1, 1, {1, 0, 0.51}));
    EXPECT_TRUE(axis.violated(1, 1, {1, 0, std::nan("")}));
    EXPECT_TRUE(axis.violated(1, 1, {1, 0, std::numeric_limits<double>::infinity()}));
    EXPECT_TRUE(axis.violated(1, 1, {1, 0, {}}));
}

TEST(StabilitySweep, NamesAMethodThatMissesItsLimit) {
    const Axis sound = made_axis(0), broken = made_axis(3);
    const auto good = sweep({&sound, 1}, {});
    EXPECT_TRUE(violations(good[0]).empty());
    EXPECT_EQ(violations_text(good), "");
    const auto bad = sweep({&broken, 1}, {});
    ASSERT_EQ(violations(bad[0]).size(), 1u);
    EXPECT_EQ(violations_text(bad), "made: good at 10: 3 of 1000 fail (limit 0)\n");
    EXPECT_NE(to_json({}, bad).find("\"failures\": 3, \"rate\": 0.003, "), std::string::npos);
    EXPECT_NE(to_json({}, bad).find("\"limit\": 0, \"ok\": false"), std::string::npos);
    EXPECT_EQ(to_json({}, good).find("\"ok\": false"), std::string::npos);
}

TEST(StabilitySweep, QuickHasFewerTrialsAndLeavesOutTheLongest) {
    Axis axis = made_axis(0);
    axis.quick_to = 5;
    const auto quick = sweep({&axis, 1}, {true, 1, 1});
    ASSERT_EQ(quick[0].outcomes.size(), 1u);
    EXPECT_EQ(quick[0].outcomes[0][0].trials, 10u);
    EXPECT_EQ(sweep({&axis, 1}, {})[0].outcomes.size(), 2u);
}

/// The axes of the name's beginning.
std::vector<Axis> some_axes(std::initializer_list<std::string> names) {
    std::vector<Axis> chosen;
    for (Axis& axis : all_axes())
        for (const std::string& name : names)
            if (axis.name == name)
                chosen.push_back(std::move(axis));
    return chosen;
}

TEST(StabilitySweep, IsTheSameForAnyNumberOfThreadsAndAnyChoiceOfAxes) {
    const auto both = some_axes({"slab-thin", "frame"}), one = some_axes({"frame"});
    const SweepOptions options{true, 1, 7};
    std::size_t steps = 0;
    const auto alone = sweep(both, options, [&](std::size_t done, std::size_t all, const Axis&) {
        EXPECT_EQ(done, ++steps);
        EXPECT_EQ(all, 9u + 11u);
    });
    EXPECT_EQ(to_json({}, sweep(both, {true, 3, 7})), to_json({}, alone));
    const auto frame = sweep(one, options);
    for (std::size_t s = 0; s < frame[0].outcomes.size(); ++s)
        for (std::size_t m = 0; m < frame[0].outcomes[s].size(); ++m) {
            const double a = frame[0].axis.badness(frame[0].outcomes[s][m]);
            EXPECT_EQ(a, alone[1].axis.badness(alone[1].outcomes[s][m]));
        }
    EXPECT_NE(to_json({}, sweep(both, {true, 1, 8})), to_json({}, alone)) << "another seed";
}

TEST(StabilityReport, HasALineForEachAxisOfAtMostAHundredCharacters) {
    const auto chosen = some_axes({"slab-plane", "frame", "roulette"});
    const std::string table = table_text(sweep(chosen, {true, 1, 1}));
    std::size_t lines = 0;
    for (std::size_t begin = 0; begin < table.size(); ++lines) {
        const std::size_t end = table.find('\n', begin);
        EXPECT_LT(end - begin, 100u);
        begin = end + 1;
    }
    EXPECT_EQ(lines, 4u);
    EXPECT_NE(table.find("infinite  fixed-axis"), std::string::npos) << table;
}

} // namespace
} // namespace plumb::test
