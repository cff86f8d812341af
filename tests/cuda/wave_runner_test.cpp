/// \file  The order of a wavefront's stages, and how seldom the host waits for a device.

#include "cuda/wave_runner.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>
#include <vector>

namespace plumb::test {
namespace {

/// A device on which alive[d] paths come to depth d + 1 and every second of them has a shadow ray.
class ScriptedDevice {
  public:
    explicit ScriptedDevice(std::vector<std::uint32_t> alive) : alive_(std::move(alive)) {}

    RayCounts run(int max_depth, CudaSchedule schedule = CudaSchedule::wavefront) {
        DeviceJob device;
        device.batch = {0, alive_[0], 5, 6};
        device.job.path.max_depth = max_depth;
        const WaveView view{nullptr, nullptr, queues_, queues_ + 1, nullptr, &counters_};
        return WaveRunner(*this, view, alive_[0], schedule).run(device);
    }
    [[nodiscard]] std::uint32_t alive(std::size_t depth) const {
        return depth <= alive_.size() ? alive_[depth - 1] : 0;
    }
    [[nodiscard]] std::uint32_t shadows(std::size_t depth) const { return alive(depth) / 2; }

    void launch(WaveStage stage, const WaveJob& job) {
        const auto depth = static_cast<std::size_t>(job.depth);
        launches.push_back({stage, job.depth});
        switch (stage) {
        case WaveStage::generate:
        case WaveStage::accumulate: EXPECT_EQ(job.threads, alive_[0]); break;
        case WaveStage::extend_persistently:
            EXPECT_EQ(job.filled().taken, 0u); // of an earlier depth
            EXPECT_EQ(job.paths(), alive(depth));
            job.filled().taken = job.paths();
            break;
        case WaveStage::extend: EXPECT_EQ(job.paths(), alive(depth)); break;
        case WaveStage::shade:
            EXPECT_EQ(job.paths(), alive(depth));
            EXPECT_EQ(job.filled().next + job.filled().shadow, 0u); // of an earlier depth
            EXPECT_EQ(job.wave.now, queues_ + (depth + 1) % 2);
            EXPECT_EQ(job.wave.next, queues_ + depth % 2);
            job.filled().next = alive(depth + 1);
            job.filled().shadow = shadows(depth);
            break;
        case WaveStage::shadow: EXPECT_EQ(job.filled().shadow, shadows(depth)); break;
        }
        EXPECT_GE(job.threads, alive(depth));
        threads.push_back(job.threads);
    }
    void clear_counters() { counters_ = {}; }
    RunCounters counters() {
        ++waits;
        return counters_;
    }

    struct Launch {
        WaveStage stage;
        int depth;
        bool operator==(const Launch&) const = default;
    };
    std::vector<Launch> launches;
    std::vector<std::uint32_t> threads;
    std::size_t waits = 0;

  private:
    std::vector<std::uint32_t> alive_;
    std::uint32_t queues_[2] = {};
    RunCounters counters_{};
};

std::vector<std::uint32_t> halving(std::size_t depths) {
    std::vector<std::uint32_t> alive(depths);
    for (std::size_t i = 0; i < depths; ++i)
        alive[i] = std::max(1000u >> std::min<std::size_t>(i, 9), 1u);
    return alive;
}

TEST(WaveRunner, CountsTheRaysOfEveryDepthAndWaitsForFew) {
    for (const std::size_t depths : {1u, 2u, 7u, 8u, 9u, 16u, 17u, 300u}) {
        const auto alive = halving(depths);
        ScriptedDevice device(alive);
        const RayCounts rays = device.run(-1);
        EXPECT_EQ(rays.camera, 1000u);
        EXPECT_EQ(rays.camera + rays.bounce, std::accumulate(alive.begin(), alive.end(), 0u));
        std::uint64_t shadows = 0;
        for (std::size_t depth = 1; depth <= depths; ++depth)
            shadows += device.shadows(depth);
        EXPECT_EQ(rays.shadow, shadows) << depths;
        EXPECT_EQ(device.waits, (depths + depths_ahead - 1) / depths_ahead);
    }
}

TEST(WaveRunner, LaunchesNoDepthThatNoPathCanReach) {
    for (const int max_depth : {1, 3, 8, 9, 20}) {
        ScriptedDevice device(halving(static_cast<std::size_t>(max_depth)));
        static_cast<void>(device.run(max_depth));
        std::vector<ScriptedDevice::Launch> expected{{WaveStage::generate, 0}};
        for (int depth = 1; depth <= max_depth; ++depth)
            for (const WaveStage stage : {WaveStage::extend, WaveStage::shade, WaveStage::shadow})
                expected.push_back({stage, depth});
        expected.push_back({WaveStage::accumulate, max_depth + 1});
        auto found = device.launches;
        found.front().depth = 0;
        EXPECT_EQ(found, expected) << max_depth;
    }
}

TEST(WaveRunner, PersistentThreadsTraceAllButCameraRays) {
    for (const CudaSchedule schedule : {CudaSchedule::wavefront, CudaSchedule::persistent}) {
        ScriptedDevice device(halving(20));
        EXPECT_GT(device.run(-1, schedule).bounce, 0u);
        for (const ScriptedDevice::Launch& launch : device.launches) {
            const bool persistent = launch.stage == WaveStage::extend_persistently;
            if (persistent || launch.stage == WaveStage::extend) {
                EXPECT_EQ(persistent, schedule == CudaSchedule::persistent && launch.depth > 1);
            }
        }
    }
}

TEST(WaveRunner, LaunchesShrinkWithThePathsThatAreLeft) {
    ScriptedDevice device(halving(20));
    static_cast<void>(device.run(-1));
    const auto threads_at = [&](std::size_t depth) { return device.threads[1 + 3 * (depth - 1)]; };
    EXPECT_EQ(threads_at(depths_ahead), 1000u);
    EXPECT_EQ(threads_at(depths_ahead + 1), 3u); // 1000 / 2^8
    EXPECT_EQ(threads_at(2 * depths_ahead + 1), 1u);
}

} // namespace
} // namespace plumb::test
