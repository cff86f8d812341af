/// \file  The project's own sine, cosine and arc tangent against the C library in extended
/// precision.

#include "accel/math/elementary.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace plumb::test {
namespace {

constexpr long double pi_long = 3.141592653589793238462643383279502884L;

struct Worst {
    double absolute = 0, relative = 0;

    void compare(float found, long double exact) {
        const long double error = std::fabs(static_cast<long double>(found) - exact);
        absolute = std::max(absolute, static_cast<double>(error));
        if (exact != 0)
            relative = std::max(relative, static_cast<double>(error / std::fabs(exact)));
    }
};

/// Every 2^-20 of [-1, 1].
TEST(SincosTurns, IsWithinItsStatedErrorOverTheWholeRange) {
    Worst sine, cosine;
    double length = 0;
    for (int i = -(1 << 20); i <= 1 << 20; ++i) {
        const float u = static_cast<float>(i) * 0x1p-20f;
        const long double angle = 2 * pi_long * static_cast<long double>(u);
        const SinCos found = sincos_turns(u);
        sine.compare(found.sin, std::sin(angle));
        cosine.compare(found.cos, std::cos(angle));
        const double s = static_cast<double>(found.sin), c = static_cast<double>(found.cos);
        length = std::max(length, std::fabs(s * s + c * c - 1));
    }
    EXPECT_LT(sine.absolute, 2e-7);
    EXPECT_LT(cosine.absolute, 2e-7);
    EXPECT_LT(length, 4e-7);
}

TEST(SincosTurns, IsExactAtTheQuarters) {
    const float sines[] = {0, 1, 0, -1, 0};
    const float cosines[] = {1, 0, -1, 0, 1};
    for (int q = 0; q <= 4; ++q) {
        const SinCos plus = sincos_turns(0.25f * static_cast<float>(q));
        const SinCos minus = sincos_turns(-0.25f * static_cast<float>(q));
        EXPECT_EQ(plus.sin, sines[q]);
        EXPECT_EQ(plus.cos, cosines[q]);
        EXPECT_EQ(minus.sin, -sines[q]);
        EXPECT_EQ(minus.cos, cosines[q]);
    }
}

/// The octant boundaries, where the quadrant changes, and the last number below a whole turn.
TEST(SincosTurns, IsAccurateOnBothSidesOfEveryOctant) {
    Worst worst;
    for (int octant = -8; octant <= 8; ++octant) {
        const float at = 0.125f * static_cast<float>(octant);
        for (const float u : {std::nextafter(at, -2.0f), at, std::nextafter(at, 2.0f)}) {
            if (std::fabs(u) > 1)
                continue;
            const long double angle = 2 * pi_long * static_cast<long double>(u);
            worst.compare(sincos_turns(u).sin, std::sin(angle));
            worst.compare(sincos_turns(u).cos, std::cos(angle));
        }
    }
    EXPECT_LT(worst.absolute, 2e-7);
}

TEST(SincosTurns, KeepsTheRelativeAccuracyOfSmallSines) {
    Worst worst;
    Random random(2);
    for (int i = 0; i < 200000; ++i) {
        const float u = std::ldexp(random.uniform(-1, 1), -3 - static_cast<int>(random.index(60)));
        worst.compare(sincos_turns(u).sin, std::sin(2 * pi_long * static_cast<long double>(u)));
    }
    EXPECT_LT(worst.relative, 4e-7);
}

TEST(SincosRadians, IsWithinAMillionthOverAFullTurnEitherWay) {
    Worst worst;
    Random random(3);
    for (int i = 0; i < 1000000; ++i) {
        const float x = random.uniform(-2 * pi, 2 * pi);
        const SinCos found = sincos_radians(x);
        worst.compare(found.sin, std::sin(static_cast<long double>(x)));
        worst.compare(found.cos, std::cos(static_cast<long double>(x)));
    }
    EXPECT_LT(worst.absolute, 1e-6);
}

TEST(Atan2, IsWithinItsStatedRelativeErrorInEveryDirection) {
    Worst worst;
    Random random(4);
    for (int i = 0; i < 2000000; ++i) { // the whole turn, evenly
        const double turn = 2 * static_cast<double>(pi) * random.uniform_double();
        const float x = static_cast<float>(std::cos(turn)), y = static_cast<float>(std::sin(turn));
        worst.compare(atan2(y, x),
                      std::atan2(static_cast<long double>(y), static_cast<long double>(x)));
    }
    EXPECT_LT(worst.relative, 4e-7);
}

TEST(Atan2, IsWithinItsStatedRelativeErrorAtEveryRatio) {
    Worst worst;
    Random random(5);
    for (int i = 0; i < 2000000; ++i) {
        const auto number = [&] {
            const int exponent = static_cast<int>(random.index(100)) - 50;
            return std::ldexp(random.uniform(-1, 1), exponent);
        };
        const float x = number(), y = number();
        const long double exact =
            std::atan2(static_cast<long double>(y), static_cast<long double>(x));
        if (std::fabs(exact) > 1e-36L) // below, the quotient is denormal
            worst.compare(atan2(y, x), exact);
    }
    EXPECT_LT(worst.relative, 4e-7);
}

TEST(Atan2, IsExactOnTheAxesAndZeroAtTheOrigin) {
    EXPECT_EQ(atan2(0, 0), 0.0f);
    EXPECT_EQ(atan2(0, 2), 0.0f);
    EXPECT_EQ(atan2(3, 0), pi / 2);
    EXPECT_EQ(atan2(-3, 0), -pi / 2);
    EXPECT_EQ(atan2(0, -1), pi);
    EXPECT_EQ(atan2(1, 1), pi / 4);
    EXPECT_EQ(atan2(1, -1), pi - pi / 4);
    EXPECT_EQ(atan2(1, 1e-38f), pi / 2);
}

} // namespace
} // namespace plumb::test
