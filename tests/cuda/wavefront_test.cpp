/// \file  The stages of the wavefront by themselves.

#include "cuda/wavefront.h"

#include <gtest/gtest.h>
#include <vector>

namespace plumb::test {
namespace {

TEST(Wavefront, APathBringsItsRadianceTimesTheWeightOfItsCameraSample) {
    std::vector<PathState> paths(6);
    for (std::size_t slot = 0; slot < 6; ++slot) {
        paths[slot].radiance = {slot % 2 == 0 ? 1.0f : 2.0f, 0, 0};
        paths[slot].weight = 0.5f;
    }
    std::vector<FilmPixel> film(2);
    WaveJob job;
    job.device.batch = {0, 2, 4, 7};
    job.device.film = film.data();
    job.wave.paths = paths.data();
    for (std::uint32_t thread = 0; thread < 2; ++thread)
        accumulate_thread(job, {0, thread, 2});
    EXPECT_EQ(film[0].sum[0], 1.5);
    EXPECT_EQ(film[1].sum[0], 3);
}

} // namespace
} // namespace plumb::test
