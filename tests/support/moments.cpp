#include "tests/support/moments.h"

#include <cmath>

namespace plumb::test {

void Moments::add(double sample) {
    Moments one;
    one.count_ = 1;
    one.mean_ = sample;
    one.max_abs_ = std::fabs(sample);
    merge(one);
}

void Moments::merge(const Moments& other) {
    if (other.count_ == 0)
        return;
    const double a = static_cast<double>(count_), b = static_cast<double>(other.count_);
    const double n = a + b, d = other.mean_ - mean_, d2 = d * d, ab = a * b;
    m4_ += other.m4_ + d2 * d2 * ab * (a * a - ab + b * b) / (n * n * n) +
           6 * d2 * (a * a * other.m2_ + b * b * m2_) / (n * n) +
           4 * d * (a * other.m3_ - b * m3_) / n;
    m3_ += other.m3_ + d * d2 * ab * (a - b) / (n * n) + 3 * d * (a * other.m2_ - b * m2_) / n;
    m2_ += other.m2_ + d2 * ab / n;
    mean_ += d * b / n;
    count_ += other.count_;
    max_abs_ = std::fmax(max_abs_, other.max_abs_);
}

double Moments::variance() const { return count_ < 2 ? 0 : m2_ / static_cast<double>(count_ - 1); }

double Moments::standard_error() const {
    return count_ == 0 ? 0 : std::sqrt(variance() / static_cast<double>(count_));
}

double Moments::kurtosis() const {
    return m2_ > 0 ? static_cast<double>(count_) * m4_ / (m2_ * m2_) : 1;
}

double relative_error_of_variance(double kurtosis, double count) {
    return std::sqrt((kurtosis - (count - 3) / (count - 1)) / count);
}

} // namespace plumb::test
