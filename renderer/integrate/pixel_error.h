/// \file  The relative error of pixels and of an image, from the film's sums (Welford, double).
///
/// Of a pixel: half the width of the 95 % confidence interval of its luminance, over its luminance
/// or over a tenth of the image's mean luminance, whichever is larger (a confidence interval as the
/// measure of a pixel: W. Purgathofer, "A statistical method for adaptive stochastic sampling",
/// Computers & Graphics 11(2), 1987). Of an image: the error that 99 % of its pixels do not exceed.
/// Not the root mean square: it would be met by uniform sampling with no more samples, and one
/// pixel in a thousand can hold all of it.
///
/// The film keeps variances of channels, not of luminance: the bound sigma(sum w c) <= sum w
/// sigma(c) is taken, exact where the channels rise and fall together, as under a white lamp.
/// Samples of one Owen-scrambled Sobol' sequence are counted as if they were independent. Their
/// mean varies less, by little where a pixel is rough and by orders of magnitude where it is smooth
/// (A. Owen, "Monte Carlo variance of scrambled net quadrature", SIAM Journal on Numerical Analysis
/// 34(5), 1997): the error is overestimated and a render stops late, never early. An estimate from
/// independently scrambled batches would be closer, but a few batches a pixel know the variance to
/// tens of per cent only, and many would lose what the longer sequence gains.
#pragma once

#include "renderer/integrate/film.h"

#include <span>

namespace plumb {

inline constexpr double confidence_95 = 1.959963984540054; ///< standard deviations, two-sided
inline constexpr double floor_of_mean = 0.1;               ///< of the image's mean luminance
inline constexpr double share_of_pixels = 0.99;

/// Luminance of the mean of the samples; 0 without any.
[[nodiscard]] double mean_luminance(const FilmPixel& pixel);
/// Mean of that over all pixels that have samples; 0 without any.
[[nodiscard]] double mean_luminance(std::span<const FilmPixel> pixels);

/// Error of a pixel that has `samples` samples of the variance seen in `pixel`, relative to at
/// least `floor` (a luminance). Infinite for fewer than two samples seen, 0 without variance.
[[nodiscard]] double relative_error(const FilmPixel& pixel, double samples, double floor);

/// The error that share_of_pixels of them do not exceed; infinite without pixels.
[[nodiscard]] double error_of_image(std::span<const float> pixel_errors);
[[nodiscard]] double error_of_image(std::span<const FilmPixel> pixels);

/// Mean of two estimates of one pixel from independent samples, each with half the weight whatever
/// its number of samples; of one of them where the other has none. `count` is that of both
/// together, and m2 / (count - 1) / count is the variance of the mean.
[[nodiscard]] FilmPixel mean_of_halves(const FilmPixel& a, const FilmPixel& b);

} // namespace plumb
