/// \file  Samples of a batch in memory, a slot each, and as many at a time as there are slots.
///
/// An image of few pixels fills a device by its samples; and however a path is scheduled, its pixel
/// adds the slots of its samples in order.
#pragma once

#include "cuda/grid.h"
#include "renderer/integrate/film.h"
#include "renderer/integrate/pixel.h"

#include <algorithm>

namespace plumb {

/// Samples [first_sample, end_sample) of some pixels. Pixels of the crop are numbered row by row
/// from 0. Slot s of a batch of n pixels: sample s / n, pixel s % n.
struct Batch {
    std::uint64_t first_pixel = 0;
    std::uint32_t pixel_count = 0;
    std::uint32_t first_sample = 0, end_sample = 0; ///< of each pixel

    [[nodiscard]] RT_HD std::uint32_t samples() const { return end_sample - first_sample; }
    /// Fewer than 2^32 in a wave.
    [[nodiscard]] RT_HD std::uint32_t slots() const { return pixel_count * samples(); }
};

/// Where and when a slot's sample is.
struct SlotSample {
    int x, y;
    std::uint32_t index;

    RT_HD SlotSample(const Crop& crop, const Batch& batch, std::uint32_t slot) {
        const std::uint64_t pixel = batch.first_pixel + slot % batch.pixel_count;
        const auto width = static_cast<std::uint64_t>(crop.width);
        x = crop.x + static_cast<int>(pixel % width);
        y = crop.y + static_cast<int>(pixel / width);
        index = batch.first_sample + slot / batch.pixel_count;
    }
    [[nodiscard]] RT_HD Sampler sampler(const RenderJob& job) const {
        return {job.sampler.kind, job.sampler.seed, pixel_number(job, x, y), index};
    }
    [[nodiscard]] RT_HD CameraSample camera(const RenderJob& job, const FilterTable& filter,
                                            const Sampler& sampler) const {
        const Sample4 u = sampler.group(0);
        return camera_sample(job, filter, x, y, {u.x[0], u.x[1]});
    }
};

/// Item i: adds the samples of pixel i of the batch to film[i], in their order.
/// `sample_of(slot)`: its weighted radiance.
template <class SampleOf>
RT_HD void add_samples(const Batch& batch, FilmPixel* film, bool with_variance, GridPosition at,
                       SampleOf&& sample_of) {
    if (at.index() >= batch.pixel_count)
        return;
    FilmPixel sum = film[at.index()];
    for (std::uint32_t s = 0; s < batch.samples(); ++s)
        sum.add(sample_of(std::uint64_t{s} * batch.pixel_count + at.index()), with_variance);
    film[at.index()] = sum;
}

/// Samples of a pixel in a wave at most: one thread adds them one after the other.
inline constexpr std::uint32_t most_wave_samples = 4096;

/// Calls run(batch) for the samples of `whole`, in order, with at most `slots` at a time, which
/// must be its pixels at least.
template <class Run> void in_waves(const Batch& whole, std::uint32_t slots, Run&& run) {
    const std::uint32_t at_once = std::clamp(slots / whole.pixel_count, 1u, most_wave_samples);
    Batch wave = whole;
    for (std::uint32_t first = whole.first_sample; first < whole.end_sample;
         first = wave.end_sample) {
        wave.first_sample = first;
        wave.end_sample = first + std::min(at_once, whole.end_sample - first);
        run(wave);
    }
}

} // namespace plumb
