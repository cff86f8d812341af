/// \file  Samples each pixel until its error is small enough, without bias.
///
/// A pixel that stops by what its own samples say is biased: it stops early where they happen to be
/// alike, which for skewed samples is where they are too dark (D. Kirk, J. Arvo, "Unbiased sampling
/// techniques for image synthesis", SIGGRAPH 1991). Their remedy, a pilot that is thrown away, is
/// here done without throwing it away. The image is the mean of two halves from independent random
/// numbers, and each half is the judge of the other:
///
/// - Both halves of a pixel get the same number n of samples in each round, n = 32, 48, 64, 96 ...
///   and with their own seeds.
/// - A half's estimate of a pixel is settled (its mean of n samples becomes final) in the first
///   round in which the OTHER half predicts an error within the target for this pixel and its
///   eight neighbours, or for share_of_pixels of the image.
/// - The pixel gets samples until both of its halves are settled. What a half settled earlier gets
///   beyond its n serves its judgement only.
///
/// So the number of samples of half A is a function of half B's samples alone: A's mean is that of
/// a number of samples that does not depend on them, which is unbiased; B's likewise; and so is
/// their mean with weights 1/2. All that a judge uses comes from its own half, the floor of the
/// relative error (from the first round) and the errors of neighbours (of as many samples as the
/// judge was asked for) too. Neighbours count because 32 samples can miss what is rare.
///
/// A time limit or a signal ends pixels where they are: time depends a little on the samples, but
/// not through their values.
#pragma once

#include "renderer/integrate/tiles.h"

namespace plumb {

/// Renders to options.stop.target_error with at most job.sampler.spp samples a pixel (one less
/// where that is odd) and within options.stop.time_limit_s. Sets stats.rays and stopped_by. The
/// film keeps variances as mean_of_halves says.
[[nodiscard]] Film render_adaptively(const RenderJob& job, const TileRenderer& tiles,
                                     const RenderOptions& options, RenderStats& stats);

} // namespace plumb
