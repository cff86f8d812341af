/// \file  The first four moments of a stream of samples.
#pragma once

#include <cstdint>

namespace plumb::test {

/// Mean, variance and kurtosis in one pass and in parts (P. Pébay, "Formulas for Robust, One-Pass
/// Parallel Computation of Covariances and Arbitrary-Order Statistical Moments", SAND2008-6212).
class Moments {
  public:
    void add(double sample);
    /// Samples of another stream, as if added here.
    void merge(const Moments& other);

    [[nodiscard]] std::uint64_t count() const { return count_; }
    [[nodiscard]] double mean() const { return mean_; }
    /// Unbiased (divided by N - 1); 0 for fewer than two samples.
    [[nodiscard]] double variance() const;
    /// Of the mean: sqrt(variance / N).
    [[nodiscard]] double standard_error() const;
    /// Fourth central moment over the square of the second: 3 for a normal distribution, at least
    /// 1. 1 where all samples are the same.
    [[nodiscard]] double kurtosis() const;
    [[nodiscard]] double max_abs() const { return max_abs_; }

  private:
    std::uint64_t count_ = 0;
    double mean_ = 0, m2_ = 0, m3_ = 0, m4_ = 0, max_abs_ = 0;
};

/// Standard error of the sample variance of `count` independent samples, relative to the variance:
/// sqrt((kurtosis - (n - 3) / (n - 1)) / n) (e.g. Mood, Graybill and Boes 1974, VI.2, theorem 2).
[[nodiscard]] double relative_error_of_variance(double kurtosis, double count);

} // namespace plumb::test
