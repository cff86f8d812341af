/// \file  The stages of the wavefront by themselves.

#include "cuda/wavefront.h"

#include <gtest/gtest.h>
#include <vector>

namespace plumb::test {
namespace {

TEST(Wavefront, PixelsAddTheSamplesOfTheirSlotsInOrder) {
    // Two pixels, three samples: 1 + 1e30 - 1e30 is 0 in this order and 1 in the other.
    const float samples[3] = {1, 1e30f, -1e30f};
    std::vector<PathState> paths(6);
    for (std::size_t s = 0; s < 3; ++s)
        for (std::size_t pixel = 0; pixel < 2; ++pixel) {
            paths[2 * s + pixel].radiance = {samples[s], pixel == 0 ? 1.0f : 2.0f, 0};
            paths[2 * s + pixel].weight = 0.5f;
        }
    std::vector<FilmPixel> film(2);
    WaveJob job;
    job.device.batch = {0, 2, 4, 7};
    job.device.film = film.data();
    job.wave.paths = paths.data();
    for (std::uint32_t thread = 0; thread < 4; ++thread) // two too many
        accumulate_thread(job, {0, thread, 4});
    for (std::size_t pixel = 0; pixel < 2; ++pixel) {
        EXPECT_EQ(film[pixel].count, 3u);
        EXPECT_EQ(film[pixel].sum[0], 0);
        EXPECT_EQ(film[pixel].sum[1], pixel == 0 ? 1.5 : 3);
    }
}

} // namespace
} // namespace plumb::test
