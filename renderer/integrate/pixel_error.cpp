#include "renderer/integrate/pixel_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb {
namespace {

constexpr double weight[3] = {0.212671, 0.715160, 0.072169}; // Rec. 709
constexpr double unknown = std::numeric_limits<double>::infinity();

} // namespace

double mean_luminance(const FilmPixel& pixel) {
    if (pixel.count == 0)
        return 0;
    return (weight[0] * pixel.sum[0] + weight[1] * pixel.sum[1] + weight[2] * pixel.sum[2]) /
           pixel.count;
}

double mean_luminance(std::span<const FilmPixel> pixels) {
    double sum = 0, n = 0;
    for (const FilmPixel& pixel : pixels) {
        sum += mean_luminance(pixel);
        n += pixel.count > 0 ? 1 : 0;
    }
    return n > 0 ? sum / n : 0;
}

double relative_error(const FilmPixel& pixel, double samples, double floor) {
    if (pixel.count < 2)
        return unknown;
    double deviation = 0;
    for (int c = 0; c < 3; ++c)
        deviation += weight[c] * std::sqrt(pixel.m2[c] / (pixel.count - 1));
    const double half_width = confidence_95 * deviation / std::sqrt(samples);
    return half_width > 0 ? half_width / std::max({mean_luminance(pixel), floor, 0.0}) : 0;
}

double error_of_image(std::span<const float> pixel_errors) {
    if (pixel_errors.empty())
        return unknown;
    std::vector<float> errors(pixel_errors.begin(), pixel_errors.end());
    const double n = static_cast<double>(errors.size());
    const auto rank = static_cast<std::ptrdiff_t>(std::ceil(share_of_pixels * n)) - 1;
    std::nth_element(errors.begin(), errors.begin() + rank, errors.end());
    return static_cast<double>(errors[static_cast<std::size_t>(rank)]);
}

double error_of_image(std::span<const FilmPixel> pixels) {
    const double floor = floor_of_mean * mean_luminance(pixels);
    std::vector<float> errors;
    errors.reserve(pixels.size());
    for (const FilmPixel& pixel : pixels)
        errors.push_back(static_cast<float>(relative_error(pixel, pixel.count, floor)));
    return error_of_image(errors);
}

FilmPixel mean_of_halves(const FilmPixel& a, const FilmPixel& b) {
    if (a.count == 0 || b.count == 0)
        return a.count == 0 ? b : a;
    const double na = a.count, nb = b.count, n = na + nb;
    FilmPixel mean;
    mean.count = a.count + b.count;
    for (int c = 0; c < 3; ++c) {
        mean.sum[c] =
            a.count == b.count ? a.sum[c] + b.sum[c] : 0.5 * n * (a.sum[c] / na + b.sum[c] / nb);
        const double variance = (a.m2[c] + b.m2[c]) / std::max(n - 2, 1.0);
        mean.m2[c] = 0.25 * variance * (1 / na + 1 / nb) * n * (n - 1);
    }
    return mean;
}

} // namespace plumb
