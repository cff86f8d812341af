/// \file  The film: sums of samples in double.
#pragma once

#include "renderer/scene/image.h"

#include <cstdint>
#include <span>
#include <vector>

namespace plumb {

/// One pixel. Sums are double: float sums lose 66 % of 1e8 samples. The second moment is Welford's.
struct FilmPixel {
    double sum[3] = {};
    double m2[3] = {}; ///< sum of squared deviations from the mean
    std::uint32_t count = 0;

    RT_HD void add(Rgb sample, bool with_variance) {
        const double x[3] = {static_cast<double>(sample.r), static_cast<double>(sample.g),
                             static_cast<double>(sample.b)};
        const double n = static_cast<double>(count);
        for (int c = 0; c < 3; ++c) {
            if (with_variance && count > 0) {
                // mean before and after: sum / n and (sum + x) / (n + 1)
                const double before = sum[c] / n, after = (sum[c] + x[c]) / (n + 1);
                m2[c] += (x[c] - before) * (x[c] - after);
            }
            sum[c] += x[c];
        }
        ++count;
    }
};

/// The rendered part of the film. Pixels are written by one thread each.
class Film {
  public:
    Film(int full_width, int full_height, const Crop& crop, bool with_variance);

    [[nodiscard]] const Crop& crop() const { return crop_; }
    [[nodiscard]] bool with_variance() const { return with_variance_; }
    /// (x, y) in the full film, inside the crop.
    [[nodiscard]] FilmPixel& pixel(int x, int y);
    /// All pixels of the crop, row by row.
    [[nodiscard]] std::span<FilmPixel> pixels() { return pixels_; }
    [[nodiscard]] std::span<const FilmPixel> pixels() const { return pixels_; }
    /// Keeps the variance no longer, for later samples and for resolve().
    void forget_variance() { with_variance_ = false; }
    [[nodiscard]] std::size_t bytes() const { return pixels_.size() * sizeof(FilmPixel); }
    /// Means, and variances of one sample where they were kept; pixels without samples are black.
    [[nodiscard]] Image resolve() const;

  private:
    int full_width_, full_height_;
    Crop crop_;
    bool with_variance_;
    std::vector<FilmPixel> pixels_;
};

} // namespace plumb
