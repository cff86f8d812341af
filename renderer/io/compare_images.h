/// \file  How far two images lie apart: error measures, and z-tests when their noise is known.
///
/// Per-pixel z-test with Šidák's correction: Z. Šidák, "Rectangular Confidence Regions for the
/// Means of Multivariate Normal Distributions", JASA 62 (1967). It sees structure in the noise; the
/// z-test of the image mean sees a bias that is spread over all pixels. Use both.
#pragma once

#include "renderer/scene/image.h"

#include <array>
#include <cstddef>

namespace plumb {

/// Index r, g, b.
using PerChannel = std::array<double, 3>;

/// Differences a - b over all finite values; b is the reference.
struct ImageComparison {
    double mse = 0;                ///< mean of d², all channels
    double rel_mse = 0;            ///< mean of d² / (b² + 0.01), all channels
    double psnr_db = 0;            ///< 10 log10(1 / mse), peak 1; infinite for equal images
    double max_abs = 0;            ///< largest |d|
    int max_x = 0, max_y = 0;      ///< where that is, in pixels of the image held
    PerChannel mean_a{}, mean_b{}; ///< over the same values
    /// z of the mean difference, its noise taken from the scatter of the differences themselves: a
    /// paired test of the image mean that needs no variance. Infinite for a constant difference.
    PerChannel mean_z{};
    std::size_t values = 0;     ///< pixel channels compared
    std::size_t non_finite = 0; ///< left out: NaN or infinite in a or b, unless bit for bit equal
    std::size_t different_bits = 0; ///< pixel channels that do not have the same bits

    /// mean_a / mean_b; 1 where both are 0.
    [[nodiscard]] double mean_ratio(std::size_t channel) const;
    /// Largest |mean_ratio - 1| of the three channels.
    [[nodiscard]] double mean_error() const;
};

/// Throws SceneError (ErrorKind::mesh) if the sizes differ. Empty images compare as equal.
[[nodiscard]] ImageComparison compare(const Image& a, const Image& b);

/// What the two z-tests of a pair of images say.
struct ZTest {
    std::size_t tests = 0;  ///< pixel channels tested
    std::size_t failed = 0; ///< of these, p-value below `pixel_alpha`
    double pixel_alpha = 0; ///< Šidák: 1 - (1 - alpha)^(1 / tests)
    double largest_z = 0;   ///< largest |z| of a pixel channel
    int largest_x = 0, largest_y = 0;
    PerChannel mean_z{};   ///< z of the image mean
    double mean_alpha = 0; ///< Šidák over the three channels
    double mean_p = 1;     ///< smallest two-sided p-value of mean_z

    [[nodiscard]] bool pixels_pass() const { return failed == 0; }
    [[nodiscard]] bool mean_passes() const { return mean_p >= mean_alpha; }
    [[nodiscard]] bool passes() const { return pixels_pass() && mean_passes(); }
};

/// Tests the hypothesis that `a` and `b` estimate the same image. `spp_a`, `spp_b`: samples in a
/// pixel, infinite for an exact image. Image::variance is that of one sample; an image without it
/// is taken to have the other's. Independent samples are assumed: stratified ones (Sobol) have less
/// noise than variance / spp, which makes the test milder, never stricter. `alpha`: probability
/// that equal expectations fail, for each of the two tests.
///
/// Every pixel is granted the rounding error of a 16-bit half (2^-12 relative, uniform), so that a
/// noiseless pixel read from a half file passes. A value that is not finite in one image only
/// fails.
///
/// Throws SceneError (ErrorKind::mesh) if the sizes differ, neither image has variance, or an spp
/// is not positive.
[[nodiscard]] ZTest z_test(const Image& a, double spp_a, const Image& b, double spp_b,
                           double alpha = 0.01);

} // namespace plumb
