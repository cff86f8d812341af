#include "tests/support/statistics.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace plumb::test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int max_terms = 100000;

/// exp(-x) x^a / Gamma(a), the factor both expansions share.
double gamma_prefactor(double a, double x) {
    return std::exp(a * std::log(x) - x - std::lgamma(a));
}

double gamma_p_series(double a, double x) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < max_terms && std::fabs(term) > epsilon * std::fabs(sum); ++n) {
        term *= x / (a + n);
        sum += term;
    }
    return sum * gamma_prefactor(a, x);
}

double gamma_q_fraction(double a, double x) {
    constexpr double tiny = 1e-300;
    double b = x + 1 - a;
    double c = 1 / tiny, d = 1 / b, h = d;
    for (int n = 1; n < max_terms; ++n) {
        const double an = -n * (n - a);
        b += 2;
        d = an * d + b;
        c = b + an / c;
        d = 1 / (std::fabs(d) < tiny ? tiny : d);
        c = std::fabs(c) < tiny ? tiny : c;
        h *= d * c;
        if (std::fabs(d * c - 1) < epsilon)
            break;
    }
    return h * gamma_prefactor(a, x);
}

} // namespace

void MeanTest::add(double sample) {
    ++count_;
    const double delta = sample - mean_;
    mean_ += delta / static_cast<double>(count_);
    squares_ += delta * (sample - mean_);
    max_abs_ = std::fmax(max_abs_, std::fabs(sample));
}

void MeanTest::merge(const MeanTest& other) {
    if (other.count_ == 0)
        return;
    const double mine = static_cast<double>(count_), theirs = static_cast<double>(other.count_);
    const double delta = other.mean_ - mean_, total = mine + theirs;
    mean_ += delta * theirs / total;
    squares_ += other.squares_ + delta * delta * mine * theirs / total;
    count_ += other.count_;
    max_abs_ = std::fmax(max_abs_, other.max_abs_);
}

double MeanTest::variance() const {
    return count_ < 2 ? 0 : squares_ / static_cast<double>(count_ - 1);
}

double MeanTest::standard_error() const {
    return count_ == 0 ? 0 : std::sqrt(variance() / static_cast<double>(count_));
}

double MeanTest::z(double expected) const {
    const double difference = mean_ - expected, error = standard_error();
    // Rounding alone is no deviation: a constant sample may have a variance of 1e-33.
    if (std::fabs(difference) <= 1e-12 * std::fabs(expected))
        return 0;
    return error == 0 ? std::numeric_limits<double>::infinity() : difference / error;
}

double z_between(const MeanTest& a, const MeanTest& b) {
    const double difference = a.mean() - b.mean();
    if (std::fabs(difference) <= 1e-12 * std::fabs(a.mean()))
        return 0;
    return difference / std::hypot(a.standard_error(), b.standard_error());
}

double z_of_share(double successes, double trials, double probability) {
    return (successes - trials * probability) / std::sqrt(trials * probability * (1 - probability));
}

double regularized_gamma_q(double a, double x) {
    if (!(a > 0) || !(x >= 0))
        return std::numeric_limits<double>::quiet_NaN();
    if (x == 0)
        return 1;
    if (std::isinf(x))
        return 0;
    return x < a + 1 ? 1 - gamma_p_series(a, x) : gamma_q_fraction(a, x);
}

double normal_p_value(double z) { return std::erfc(std::fabs(z) / std::sqrt(2.0)); }

double chi_square_p_value(std::span<const double> observed, std::span<const double> expected) {
    if (observed.size() != expected.size())
        throw std::invalid_argument("chi_square_p_value: bins differ in number");
    double statistic = 0;
    int bins = 0;
    double o = 0, e = 0, last_o = 0, last_e = 0;
    const auto term = [](double seen, double wanted) {
        return (seen - wanted) * (seen - wanted) / wanted;
    };
    for (std::size_t i = 0; i < observed.size(); ++i) {
        if (expected[i] == 0 && observed[i] != 0)
            return 0;
        o += observed[i];
        e += expected[i];
        if (e < 5)
            continue;
        statistic += term(o, e);
        last_o = o;
        last_e = e;
        o = e = 0;
        ++bins;
    }
    if (e > 0 || o > 0) { // what is left over joins the last bin
        if (bins == 0)
            return 1;
        statistic += term(last_o + o, last_e + e) - term(last_o, last_e);
    }
    if (std::isnan(statistic))
        return 0;
    return bins < 2 ? 1 : regularized_gamma_q(0.5 * (bins - 1), 0.5 * statistic);
}

} // namespace plumb::test
