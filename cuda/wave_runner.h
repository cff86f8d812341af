/// \file  The order of the stages of a wavefront. Knows no device: tests run it on the host.
#pragma once

#include "cuda/wavefront.h"

#include <utility>

namespace plumb {

enum class WaveStage : std::uint8_t {
    generate,
    extend,
    extend_persistently, ///< the same by persistent threads: as many as the device holds, or fewer
    shade,
    shadow,
    accumulate
};

/// Runs batches as waves of at most `slots` paths. `Launcher` has
///     void launch(WaveStage stage, const WaveJob& job);  // job.threads; may return early
///     void clear_counters();
///     RunCounters counters();                            // waits for all stages
template <class Launcher> class WaveRunner {
  public:
    WaveRunner(Launcher& launcher, const WaveView& wave, std::uint32_t slots,
               CudaSchedule schedule = CudaSchedule::wavefront)
        : launcher_(launcher), wave_(wave), slots_(slots),
          persistent_(schedule == CudaSchedule::persistent) {}

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
        job.threads = job.device.batch.slots();
        launcher_.launch(WaveStage::generate, job);
        counts.camera += job.threads;
        for (job.depth = 1; job.threads > 0 && !all_end(job);)
            run_depths(job, counts);
        job.threads = job.device.batch.pixel_count;
        launcher_.launch(WaveStage::accumulate, job);
    }

    /// Whether no path has a vertex at this depth.
    [[nodiscard]] static bool all_end(const WaveJob& job) {
        return job.depth - 1 == job.device.job.path.max_depth;
    }

    /// Some depths for the `job.threads` paths that are left. Launches are as large as at the
    /// first, for there are never more paths than before.
    void run_depths(WaveJob& job, RayCounts& counts) {
        launcher_.clear_counters();
        for (job.ahead = 0; job.ahead < depths_ahead && !all_end(job); ++job.ahead, ++job.depth) {
            // Camera rays run alike: no lane waits long for another.
            launcher_.launch(persistent_ && job.depth > 1 ? WaveStage::extend_persistently
                                                          : WaveStage::extend,
                             job);
            launcher_.launch(WaveStage::shade, job);
            launcher_.launch(WaveStage::shadow, job);
            std::swap(job.wave.now, job.wave.next);
        }
        const RunCounters filled = launcher_.counters();
        for (const WaveCounters& depth : filled) { // zeros at depths that there were not
            counts.bounce += depth.next;
            counts.shadow += depth.shadow;
        }
        job.threads = filled[job.ahead - 1].next;
    }

    Launcher& launcher_;
    WaveView wave_;
    std::uint32_t slots_;
    bool persistent_;
};

} // namespace plumb
