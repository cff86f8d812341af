/// \file  Whole-token numbers: what is read, and what is refused.
#include "renderer/io/parse_number.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <limits>
#include <string>

namespace plumb {
namespace {

TEST(ParseNumber, ReadsDecimalNumbersToTheNearest) {
    EXPECT_EQ(parse_float("0.1"), 0.1f);
    EXPECT_EQ(parse_double("0.1"), 0.1);
    EXPECT_EQ(parse_float("+2.5e-3"), 2.5e-3f);
    EXPECT_EQ(parse_float(".5"), 0.5f);
    EXPECT_EQ(parse_float("-5."), -5.0f);
    EXPECT_EQ(parse_float("1E3"), 1000.0f);
    EXPECT_EQ(parse_float("3.4028234e38"), std::numeric_limits<float>::max());
    EXPECT_EQ(parse_double("1.7976931348623157e308"), std::numeric_limits<double>::max());
    EXPECT_EQ(parse_float("1e-40"), 1e-40f); // subnormal
}

TEST(ParseNumber, FlushesNumbersTooSmallToSignedZero) {
    for (const char* token : {"1e-50", "-1e-999", "1e-99999999999999999999",
                              "0.0000000000000000000000000000000000000000000000000001",
                              "123456789e-70", "0.001e-999"}) {
        const auto value = parse_float(token);
        ASSERT_TRUE(value.has_value()) << token;
        EXPECT_EQ(*value, 0.0f) << token;
        EXPECT_EQ(std::signbit(*value), token[0] == '-') << token;
    }
    EXPECT_EQ(parse_double("1e-999"), 0.0);
}

TEST(ParseNumber, RefusesWhatIsNotOneFiniteNumber) {
    for (const char* token :
         {"",         " ",    "1,5",   "12abc", "1.5.2", "nan",    "-nan",
          "inf",      "+inf", "1e999", "-1e99", "1e39",  "1e",     "1e+",
          "0x10",     "+",    "-",     "+-1",   "--1",   "++1",    " 1",
          "1 ",       ".",    "e5",    "1f",    "1_000", "nan(1)", "-1e999999999999999999999",
          "infinity", "1;"}) {
        EXPECT_FALSE(parse_float(token).has_value()) << "'" << token << "'";
        const bool fits_double = std::string(token) == "1e39" || std::string(token) == "-1e99";
        EXPECT_EQ(parse_double(token).has_value(), fits_double) << "'" << token << "'";
    }
    EXPECT_FALSE(parse_float(std::string_view("1\0", 2)).has_value());
    // More digits than any type holds, and still out of range.
    EXPECT_FALSE(parse_double("1" + std::string(400, '0')).has_value());
    EXPECT_TRUE(parse_double("1" + std::string(400, '0') + "e-400").has_value());
}

TEST(ParseNumber, RefusesIntegersThatDoNotFitRatherThanClamp) {
    EXPECT_EQ(parse_int32("-2147483648"), std::numeric_limits<std::int32_t>::min());
    EXPECT_EQ(parse_int32("+7"), 7);
    EXPECT_EQ(parse_uint32("4294967295"), 4294967295u);
    EXPECT_EQ(parse_uint64("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
    EXPECT_EQ(parse_int64("-9223372036854775808"), std::numeric_limits<std::int64_t>::min());
    EXPECT_FALSE(parse_int32("2147483648").has_value());
    EXPECT_FALSE(parse_int32("99999999999").has_value());
    EXPECT_FALSE(parse_uint32("-1").has_value());
    EXPECT_FALSE(parse_uint32("4294967296").has_value());
    EXPECT_FALSE(parse_uint64("18446744073709551616").has_value());
    for (const char* token : {"", "1.0", "1e3", "0x1", "12abc", " 1", "1 ", "+", "-", "+-1"})
        EXPECT_FALSE(parse_int32(token).has_value()) << "'" << token << "'";
}

TEST(ParseNumber, DoesNotHearTheLocale) {
    const std::string before = std::setlocale(LC_NUMERIC, nullptr);
    if (std::setlocale(LC_NUMERIC, "de_DE.UTF-8") == nullptr)
        GTEST_SKIP() << "no locale with a decimal comma is installed";
    EXPECT_EQ(parse_float("1.5"), 1.5f);
    EXPECT_FALSE(parse_float("1,5").has_value());
    std::setlocale(LC_NUMERIC, before.c_str());
}

} // namespace
} // namespace plumb
