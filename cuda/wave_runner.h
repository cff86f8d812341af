/// \file  The order of the stages of a wavefront. Knows no device: tests run it on the host.
#pragma once

#include "cuda/wavefront.h"

#include <utility>

namespace plumb {

enum class WaveStage : std::uint8_t { generate, extend, shade, shadow, accumulate };

/// Runs batches as waves of at most `slots` paths. `Launcher` has
///     void launch(WaveStage stage, const WaveJob& job);  // job.count threads; may return early
///     WaveCounters take_counters(const WaveJob& job);    // waits; returns and clears the counters
template <class Launcher> class WaveRunner {
  public:
    WaveRunner(Launcher& launcher, const WaveView& wave, std::uint32_t slots)
        : launcher_(launcher), wave_(wave), slots_(slots) {}

    /// `device.batch` must have at most `slots` pixels. Returns the rays that were traced.
    RayCounts run(const DeviceJob& device) {
        RayCounts counts;
        WaveJob job{device, wave_};
        in_waves(device.batch, slots_, [&](const Batch& batch) {
            job.device.batch = batch;
            run_wave(job, counts);
        });
        return counts;
    }

  private:
    void run_wave(WaveJob& job, RayCounts& counts) {
        job.wave = wave_;
        job.count = job.device.batch.slots();
        launcher_.launch(WaveStage::generate, job);
        for (job.depth = 1; job.count > 0; ++job.depth) {
            (job.depth == 1 ? counts.camera : counts.bounce) += job.count;
            launcher_.launch(WaveStage::extend, job);
            launcher_.launch(WaveStage::shade, job);
            const WaveCounters filled = launcher_.take_counters(job);
            job.count = filled.shadow;
            if (filled.shadow > 0)
                launcher_.launch(WaveStage::shadow, job);
            counts.shadow += filled.shadow;
            job.count = filled.next;
            std::swap(job.wave.now, job.wave.next);
        }
        job.count = job.device.batch.pixel_count;
        launcher_.launch(WaveStage::accumulate, job);
    }

    Launcher& launcher_;
    WaveView wave_;
    std::uint32_t slots_;
};

} // namespace plumb
