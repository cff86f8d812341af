#include "renderer/io/compare_images.h"

#include "renderer/scene/error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

namespace plumb {
namespace {

using Channels = std::array<float, 3>;

Channels channels(Rgb c) { return {c.r, c.g, c.b}; }

void require_same_size(const Image& a, const Image& b) {
    if (a.width == b.width && a.height == b.height && a.pixels.size() == b.pixels.size())
        return;
    const auto size = [](const Image& image) {
        return std::to_string(image.width) + "x" + std::to_string(image.height);
    };
    throw SceneError(ErrorKind::mesh, {},
                     "the images differ in size: " + size(a) + " and " + size(b));
}

bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

/// Šidák's level for one of `tests` tests that together fail with probability `alpha`.
double sidak(double alpha, double tests) { return -std::expm1(std::log1p(-alpha) / tests); }

double two_sided_p(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

/// Of a difference with the given variance; an exact value must be met exactly.
double z_of(double difference, double variance) {
    if (variance > 0)
        return difference / std::sqrt(variance);
    return difference == 0 ? 0 : std::copysign(std::numeric_limits<double>::infinity(), difference);
}

/// Of the mean of `count` differences whose squares sum to `squares`.
double paired_z(double mean, double squares, double count) {
    if (count < 2)
        return 0;
    const double variance = std::max(squares / count - mean * mean, 0.0) / (count - 1);
    return z_of(mean, variance);
}

/// Variance of rounding to a half: uniform within half an ulp, which is at most 2^-12 of the value
/// and 2^-25 among the subnormal ones.
double rounding_variance(double value) {
    const double half_ulp = std::max(0x1p-12 * std::abs(value), 0x1p-25);
    return half_ulp * half_ulp / 3;
}

/// Noise of the difference between two images, pixel by pixel.
class DifferenceVariance {
  public:
    DifferenceVariance(const Image& a, double spp_a, const Image& b, double spp_b)
        : a_(a.variance.empty() ? b.variance : a.variance),
          b_(b.variance.empty() ? a.variance : b.variance), spp_a_(spp_a), spp_b_(spp_b) {
        if (a_.size() != a.pixels.size() || b_.size() != b.pixels.size())
            throw SceneError(ErrorKind::mesh, {}, "a z-test needs the variance of the samples");
        if (!(spp_a > 0) || !(spp_b > 0))
            throw SceneError(ErrorKind::mesh, {},
                             "a z-test needs the samples per pixel of both images");
    }
    [[nodiscard]] PerChannel at(std::size_t pixel) const {
        const Channels a = channels(a_[pixel]), b = channels(b_[pixel]);
        PerChannel sum;
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] = double{a[c]} / spp_a_ + double{b[c]} / spp_b_;
        return sum;
    }

  private:
    const std::vector<Rgb>& a_;
    const std::vector<Rgb>& b_;
    double spp_a_, spp_b_;
};

/// What z_test gathers over the pixels. Those that fail are counted once the number of tests, and
/// with it the limit, is known.
struct Sums {
    PerChannel difference{}, variance{};
    std::vector<double> z;
};

void finish(ZTest& test, const Sums& sums, double alpha) {
    test.tests = sums.z.size();
    if (test.tests == 0)
        return;
    test.pixel_alpha = sidak(alpha, static_cast<double>(test.tests));
    for (const double z : sums.z)
        if (!(two_sided_p(z) >= test.pixel_alpha))
            ++test.failed;
    test.mean_alpha = sidak(alpha, 3);
    for (std::size_t c = 0; c < 3; ++c) {
        test.mean_z[c] = z_of(sums.difference[c], sums.variance[c]);
        test.mean_p = std::min(test.mean_p, two_sided_p(test.mean_z[c]));
    }
}

} // namespace

double ImageComparison::mean_ratio(std::size_t channel) const {
    const double a = mean_a.at(channel), b = mean_b.at(channel);
    return a == b ? 1 : a / b;
}

double ImageComparison::mean_error() const {
    double largest = 0;
    for (std::size_t c = 0; c < 3; ++c)
        largest = std::max(largest, std::abs(mean_ratio(c) - 1));
    return largest;
}

ImageComparison compare(const Image& a, const Image& b) {
    require_same_size(a, b);
    ImageComparison result;
    PerChannel counted{}, squares{};
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const Channels va = channels(a.pixels[i]), vb = channels(b.pixels[i]);
        for (std::size_t c = 0; c < 3; ++c) {
            const bool same = same_bits(va[c], vb[c]);
            result.different_bits += same ? 0 : 1;
            if (!std::isfinite(va[c]) || !std::isfinite(vb[c])) {
                result.non_finite += same ? 0 : 1;
                continue;
            }
            const double d = double{va[c]} - double{vb[c]};
            squares[c] += d * d;
            result.rel_mse += d * d / (double{vb[c]} * double{vb[c]} + 0.01);
            result.mean_a[c] += double{va[c]};
            result.mean_b[c] += double{vb[c]};
            counted[c] += 1;
            if (std::abs(d) > result.max_abs) {
                result.max_abs = std::abs(d);
                result.max_x = static_cast<int>(i % static_cast<std::size_t>(a.width));
                result.max_y = static_cast<int>(i / static_cast<std::size_t>(a.width));
            }
        }
    }
    const double total = counted[0] + counted[1] + counted[2];
    result.values = static_cast<std::size_t>(total);
    result.mse = (squares[0] + squares[1] + squares[2]) / std::max(total, 1.0);
    result.rel_mse /= std::max(total, 1.0);
    for (std::size_t c = 0; c < 3; ++c) {
        result.mean_a[c] /= std::max(counted[c], 1.0);
        result.mean_b[c] /= std::max(counted[c], 1.0);
        result.mean_z[c] = paired_z(result.mean_a[c] - result.mean_b[c], squares[c], counted[c]);
    }
    result.psnr_db =
        result.mse > 0 ? -10 * std::log10(result.mse) : std::numeric_limits<double>::infinity();
    return result;
}

ZTest z_test(const Image& a, double spp_a, const Image& b, double spp_b, double alpha) {
    require_same_size(a, b);
    const DifferenceVariance noise(a, spp_a, b, spp_b);
    ZTest test;
    Sums sums;
    sums.z.reserve(3 * a.pixels.size());
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const Channels va = channels(a.pixels[i]), vb = channels(b.pixels[i]);
        const PerChannel variance = noise.at(i);
        for (std::size_t c = 0; c < 3; ++c) {
            if (same_bits(va[c], vb[c]) && !std::isfinite(va[c]))
                continue;
            const double d = double{va[c]} - double{vb[c]};
            const double rounding = rounding_variance(double{vb[c]});
            double z = std::abs(z_of(d, variance[c] + rounding));
            if (std::isfinite(z)) {
                sums.difference[c] += d;
                sums.variance[c] += variance[c] + rounding;
            } else { // also where a variance is NaN: nothing excuses it
                z = std::numeric_limits<double>::infinity();
            }
            sums.z.push_back(z);
            if (z > test.largest_z) {
                test.largest_z = z;
                test.largest_x = static_cast<int>(i % static_cast<std::size_t>(a.width));
                test.largest_y = static_cast<int>(i / static_cast<std::size_t>(a.width));
            }
        }
    }
    finish(test, sums, alpha);
    return test;
}

} // namespace plumb
