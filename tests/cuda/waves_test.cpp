/// \file  How samples are put into slots and waves, and launches cut.

#include "cuda/render_batches.h"
#include "cuda/waves.h"

#include <gtest/gtest.h>
#include <set>
#include <tuple>
#include <vector>

namespace plumb::test {
namespace {

TEST(Waves, EverySampleOfTheBatchIsInOneSlotOfOneWaveInOrder) {
    for (const std::uint32_t slots : {7u, 8u, 20u, 21u, 22u, 1000u}) {
        std::uint32_t next = 3;
        in_waves({100, 7, 3, 13}, slots, [&](const Batch& wave) {
            EXPECT_EQ(wave.first_pixel, 100u);
            EXPECT_EQ(wave.pixel_count, 7u);
            EXPECT_EQ(wave.first_sample, next);
            EXPECT_LE(wave.slots(), slots);
            EXPECT_TRUE(wave.slots() + 7 > slots || wave.end_sample == 13); // as many as fit
            next = wave.end_sample;
        });
        EXPECT_EQ(next, 13u);
    }
}

TEST(Waves, NoPixelAddsMoreThanSomeThousandSamplesAtATime) {
    std::vector<std::uint32_t> samples;
    in_waves({0, 2, 0, 10000}, 1u << 20,
             [&](const Batch& wave) { samples.push_back(wave.samples()); });
    EXPECT_EQ(samples, (std::vector<std::uint32_t>{4096, 4096, 1808}));
}

TEST(Waves, SlotsOfABatchAreItsPixelsAndSamples) {
    const Crop crop{4, 2, 5, 3};
    const Batch batch{6, 8, 10, 13}; // from the second pixel of the second row on
    std::set<std::tuple<int, int, std::uint32_t>> met;
    for (std::uint32_t slot = 0; slot < batch.slots(); ++slot) {
        const SlotSample sample(crop, batch, slot);
        const int pixel = (sample.y - 2) * 5 + sample.x - 4;
        EXPECT_TRUE(sample.x >= 4 && sample.x < 9 && pixel >= 6 && pixel < 14) << slot;
        EXPECT_TRUE(sample.index >= 10 && sample.index < 13) << slot;
        met.emplace(sample.x, sample.y, sample.index);
    }
    EXPECT_EQ(met.size(), 24u);
}

TEST(Waves, PixelsAddTheirSamplesInOrder) {
    // Two pixels, three samples: 1 + 1e30 - 1e30 is 0 in this order and 1 in the other.
    const float samples[3] = {1, 1e30f, -1e30f};
    std::vector<Rgb> slots(6);
    for (std::size_t s = 0; s < 3; ++s)
        for (std::size_t pixel = 0; pixel < 2; ++pixel)
            slots[2 * s + pixel] = {samples[s], pixel == 0 ? 0.5f : 1.0f, 0};
    std::vector<FilmPixel> film(2);
    const Batch batch{0, 2, 4, 7};
    for (std::uint32_t thread = 0; thread < 4; ++thread) // two too many
        add_samples(batch, film.data(), false, {0, thread, 4},
                    [&](std::uint64_t slot) { return slots[slot]; });
    for (std::size_t pixel = 0; pixel < 2; ++pixel) {
        EXPECT_EQ(film[pixel].count, 3u);
        EXPECT_EQ(film[pixel].sum[0], 0);
        EXPECT_EQ(film[pixel].sum[1], pixel == 0 ? 1.5 : 3);
    }
}

/// Takes note of what is launched.
struct NotedLaunches {
    std::vector<Batch> batches;

    void clear(std::uint32_t /*pixels*/) {}
    RayCounts run(const Batch& batch) {
        batches.push_back(batch);
        return {};
    }
    void fetch(std::span<FilmPixel> /*film*/) {}
};

std::vector<Batch> launches(std::uint32_t spp, std::uint32_t first_paths) {
    RenderJob job;
    job.width = job.height = 10;
    job.crop = {0, 0, 10, 10};
    job.sampler.spp = spp;
    NotedLaunches executor;
    RenderStats stats;
    const RenderOptions options;
    static_cast<void>(BatchRenderer(job, options, executor, stats, first_paths).render(1000));
    return executor.batches;
}

TEST(Waves, TheFirstLaunchHasAboutSoManyPaths) {
    EXPECT_EQ(launches(64, 1).front().slots(), 100u);
    EXPECT_EQ(launches(64, 99).front().slots(), 100u);
    EXPECT_EQ(launches(64, 850).front().slots(), 800u);
    EXPECT_EQ(launches(64, 850)[1].slots(), 1600u); // short: the next is longer
    EXPECT_EQ(launches(64, 1u << 18).front().slots(), 6400u);
    EXPECT_EQ(launches(64, 1u << 18).size(), 1u);
}

} // namespace
} // namespace plumb::test
