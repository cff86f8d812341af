/// \file  "Did you mean ...?".

#include "renderer/io/nearest_name.h"

#include <array>
#include <gtest/gtest.h>

namespace plumb::test {
namespace {

constexpr std::array<std::string_view, 4> names{"radius", "center", "to_world", "max_depth"};

TEST(NearestName, FindsOneSlipOfTheFinger) {
    EXPECT_EQ(nearest_name("raduis", names), "radius");        // swapped
    EXPECT_EQ(nearest_name("centre", names), "center");        // swapped at the end
    EXPECT_EQ(nearest_name("toworld", names), "to_world");     // left out
    EXPECT_EQ(nearest_name("max_deepth", names), "max_depth"); // doubled
}

TEST(NearestName, StaysSilentWhereNothingIsNear) {
    EXPECT_EQ(nearest_name("alpha", names), "");
    EXPECT_EQ(nearest_name("", names), "");
    EXPECT_EQ(nearest_name(std::string(100, 'r'), names), "");
    EXPECT_EQ(nearest_name("radius", {}), "");
}

TEST(NearestName, TakesTheFirstOfEquals) {
    constexpr std::array<std::string_view, 2> equals{"abcx", "abcy"};
    EXPECT_EQ(nearest_name("abcz", equals), "abcx");
    EXPECT_EQ(did_you_mean("abcz", equals), " (did you mean 'abcx'?)");
    EXPECT_EQ(did_you_mean("zzzzz", equals), "");
}

} // namespace
} // namespace plumb::test
