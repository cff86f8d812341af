/// \file  Orthonormal frames (Duff et al. 2017), checked in double.

#include "accel/math/frame.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace plumb::test {
namespace {

double dot_double(Vec3 a, Vec3 b) {
    return static_cast<double>(a.x) * static_cast<double>(b.x) +
           static_cast<double>(a.y) * static_cast<double>(b.y) +
           static_cast<double>(a.z) * static_cast<double>(b.z);
}

/// Largest deviation of the frame from orthonormal and right-handed. The normal's own length is
/// the caller's rounding, up to 1e-7.
double defect(Vec3 normal) {
    const Frame f(normal);
    const Vec3 handed = cross(f.s, f.t) - normal;
    const double worst =
        std::max({std::fabs(dot_double(f.s, f.s) - 1), std::fabs(dot_double(f.t, f.t) - 1),
                  std::fabs(dot_double(f.s, f.t)), std::fabs(dot_double(f.s, normal)),
                  std::fabs(dot_double(f.t, normal)), std::sqrt(dot_double(handed, handed))});
    return std::isnan(worst) || std::isnan(f.s.x + f.t.x + handed.x) ? 1 : worst;
}

constexpr double limit = 5e-7; // stability.md, "frame from a fixed axis"

TEST(Frame, IsOrthonormalForRandomNormals) {
    Random random(21);
    double worst = 0;
    for (int i = 0; i < 500000; ++i)
        worst = std::max(worst, defect(random.direction()));
    EXPECT_LT(worst, limit);
}

TEST(Frame, IsOrthonormalOnEveryAxisAndSignedZero) {
    for (const float zero : {0.0f, -0.0f})
        for (const float one : {1.0f, -1.0f}) {
            EXPECT_LT(defect({one, zero, zero}), limit);
            EXPECT_LT(defect({zero, one, zero}), limit);
            EXPECT_LT(defect({zero, zero, one}), limit);
        }
}

TEST(Frame, IsOrthonormalCloseToMinusZAndToTheEquator) {
    // Frisvad's frame is wrong by 0.62 near -z; copysign switches at the equator.
    Random random(22);
    double worst = 0;
    for (int i = 0; i < 200000; ++i) {
        const double phi = 6.283185307179586 * random.uniform_double();
        const double small = std::exp(-30 * random.uniform_double());
        const double r = i % 2 == 0 ? small : std::sqrt(1 - small * small);
        const double z = i % 2 == 0 ? -std::sqrt(1 - small * small) : (i % 4 < 2 ? -small : small);
        worst =
            std::max(worst, defect({static_cast<float>(r * std::cos(phi)),
                                    static_cast<float>(r * std::sin(phi)), static_cast<float>(z)}));
    }
    EXPECT_LT(worst, limit);
}

TEST(Frame, ToLocalUndoesToWorld) {
    Random random(23);
    for (int i = 0; i < 1000; ++i) {
        const Frame frame(random.direction());
        const Vec3 v = random.direction();
        const Vec3 back = frame.to_local(frame.to_world(v));
        EXPECT_LT(length(back - v), 2e-6f);
        EXPECT_LT(length(frame.to_world({0, 0, 1}) - frame.n), 1e-7f);
    }
}

TEST(SafeNormalize, GivesUnitVectorsFromTinyToHuge) {
    Random random(24);
    for (const float scale : {1e-38f, 1e-30f, 1e-20f, 1.0f, 1e18f, 1e38f})
        for (int i = 0; i < 100; ++i) {
            const Vec3 d = random.direction();
            const Vec3 n = safe_normalize(scale * d);
            EXPECT_NEAR(dot_double(n, n), 1, 5e-7) << scale;
            EXPECT_LT(length(n - d), 1e-5f) << scale;
        }
    EXPECT_EQ(safe_normalize({0, 0, 0}), (Vec3{0, 0, 0}));
}

} // namespace
} // namespace plumb::test
