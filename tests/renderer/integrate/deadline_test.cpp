/// \file  Passes that fit into the time left. Bounds that a busy machine cannot break.

#include "renderer/integrate/deadline.h"

#include <gtest/gtest.h>
#include <thread>

namespace plumb::test {
namespace {

using std::chrono::milliseconds;

TEST(Deadline, WithoutALimitOnePassDoesAll) {
    Deadline none(0);
    EXPECT_EQ(none.reachable(0, 1000, 1e9), 1000u);
    none.passed();
    EXPECT_EQ(none.reachable(1000, 4000, 1e9), 4000u);
    EXPECT_EQ(none.share_used(), 0);
}

TEST(Deadline, TheFirstPassIsOneSampleHoweverLittleTimeThereIs) {
    Deadline short_one(1e-9);
    std::this_thread::sleep_for(milliseconds(1));
    EXPECT_EQ(short_one.reachable(0, 1000, 100), 1u);
    EXPECT_GE(short_one.share_used(), 1);
}

TEST(Deadline, PlentyOfTimeIsEnoughForAll) {
    Deadline day(86400);
    EXPECT_EQ(day.reachable(0, 1000, 100), 1u);
    day.passed();
    EXPECT_EQ(day.reachable(1, 1000, 100), 1000u);
}

TEST(Deadline, NothingBeginsAfterTheEnd) {
    Deadline deadline(0.01);
    EXPECT_EQ(deadline.reachable(0, 1000, 1), 1u);
    std::this_thread::sleep_for(milliseconds(20));
    deadline.passed();
    EXPECT_EQ(deadline.reachable(1, 1000, 1), 1u);
}

TEST(Deadline, NothingBeginsThatWouldNotEndInTime) {
    Deadline deadline(0.03); // the pass takes two thirds of it
    EXPECT_EQ(deadline.reachable(0, 1000, 1), 1u);
    std::this_thread::sleep_for(milliseconds(20));
    deadline.passed();
    EXPECT_EQ(deadline.reachable(1, 1000, 1), 1u);
}

/// A sample takes at least 20 ms: of the 1980 ms left at most 99 fit, of which half are begun.
TEST(Deadline, APassTakesHalfOfWhatIsLeft) {
    Deadline deadline(2);
    EXPECT_EQ(deadline.reachable(0, 1000, 1), 1u);
    std::this_thread::sleep_for(milliseconds(20));
    deadline.passed();
    const std::uint32_t end = deadline.reachable(1, 1000, 1);
    EXPECT_GT(end, 1u);
    EXPECT_LE(end, 1u + 49);
}

TEST(Deadline, FewerPixelsGetMoreSamples) {
    Deadline deadline(1000);
    EXPECT_EQ(deadline.reachable(0, 1u << 20, 100), 1u);
    std::this_thread::sleep_for(milliseconds(20));
    deadline.passed(); // at least 0.2 ms a pixel
    EXPECT_LE(deadline.reachable(1, 1u << 30, 100), 1u + 25'000);
    EXPECT_EQ(deadline.reachable(1, 5, 1), 5u); // never more than is wanted
}

} // namespace
} // namespace plumb::test
