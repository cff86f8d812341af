/// \file  What the statistical tests decide with: running moments, z-test, chi² test.
///
/// Seeds are fixed, so a test that passes once passes always; the limits keep the chance of having
/// to change a seed small. 4.75 sigma over 500 tests is a family-wise error of 1e-3.
#pragma once

#include <cstdint>
#include <span>

namespace plumb::test {

/// Largest |z| that a test of a mean accepts.
inline constexpr double z_limit = 4.75;
/// Smallest p-value that a chi² test accepts: the two-sided tail beyond z_limit.
inline constexpr double p_limit = 2.0e-6;

/// Mean and variance of a stream of samples (Welford 1962: no cancellation). Also keeps the
/// largest |sample|, because a mean test alone is blind to rare huge samples.
class MeanTest {
  public:
    void add(double sample);
    /// Samples of another stream, as if added here (Chan et al. 1979).
    void merge(const MeanTest& other);

    [[nodiscard]] std::uint64_t count() const { return count_; }
    [[nodiscard]] double mean() const { return mean_; }
    /// Unbiased (divided by N - 1); 0 for fewer than two samples.
    [[nodiscard]] double variance() const;
    /// Of the mean: sqrt(variance / N).
    [[nodiscard]] double standard_error() const;
    [[nodiscard]] double max_abs() const { return max_abs_; }
    /// Standard errors between the mean and what it should be. With zero variance: 0 where the two
    /// agree to 1e-12 relative, else infinite. NaN samples give NaN, which no limit accepts:
    /// compare with EXPECT_LE(std::fabs(z), z_limit).
    [[nodiscard]] double z(double expected) const;

  private:
    std::uint64_t count_ = 0;
    double mean_ = 0, squares_ = 0, max_abs_ = 0;
};

/// z of the difference between two independent estimates of one number.
[[nodiscard]] double z_between(const MeanTest& a, const MeanTest& b);

/// z of a count of successes out of n trials, each of probability p (normal approximation).
[[nodiscard]] double z_of_share(double successes, double trials, double probability);

/// Regularised upper incomplete gamma function Q(a, x), a > 0, x >= 0, to about 1e-12
/// (series and Lentz's continued fraction; Abramowitz and Stegun 6.5.29, 6.5.31).
[[nodiscard]] double regularized_gamma_q(double a, double x);

/// Two-sided probability of a normal deviate beyond |z|.
[[nodiscard]] double normal_p_value(double z);

/// Pearson's chi² test: how likely counts as far from `expected` as `observed` are. Both are
/// counts of the same total (fractions are welcome in `expected`), one entry a bin. Neighbouring
/// bins are pooled until each expects at least 5; degrees of freedom are pooled bins - 1. A count
/// in a stretch that expects nothing at all gives 0, as does a NaN; a single pooled bin gives 1.
[[nodiscard]] double chi_square_p_value(std::span<const double> observed,
                                        std::span<const double> expected);

} // namespace plumb::test
