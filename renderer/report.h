/// \file  What the renderer tells: progress, the closing table, --stats and --explain.
#pragma once

#include "accel/intersector.h"
#include "renderer/integrate/render.h"
#include "renderer/options.h"
#include "renderer/validate_render.h"

#include <chrono>
#include <mutex>

namespace plumb {

/// Everything measured in one run. Seconds are wall time.
struct RunReport {
    std::string scene;
    std::string accel;
    std::string device = "cpu";
    int threads = 1;
    StopSettings stop;
    double load_s = 0, write_s = 0, total_s = 0;
    AccelStats build;
    RenderStats render;
    std::optional<ValidationResult> validation;
    std::uint64_t image_hash = 0; ///< of the resolved float pixels (FNV-1a, 64 bit)
    std::size_t peak_bytes = 0;   ///< largest resident set of the process
};

/// Progress on stderr: a bar on a terminal, a plain line every 10 % (at most one a second)
/// elsewhere; with the error reached, where there is a target. Thread-safe.
class ProgressPrinter {
  public:
    /// `target_error`: 0 without one.
    ProgressPrinter(bool quiet, double target_error);
    ~ProgressPrinter();
    ProgressPrinter(const ProgressPrinter&) = delete;
    ProgressPrinter& operator=(const ProgressPrinter&) = delete;
    void update(const ProgressState& now);

  private:
    using Clock = std::chrono::steady_clock;
    void print(const ProgressState& now, double elapsed_s);

    std::mutex mutex_;
    Clock::time_point start_ = Clock::now(), last_ = start_;
    double last_done_ = 0, target_error_;
    bool quiet_, terminal_, printed_ = false;
};

/// FNV-1a over the bits of the pixels: equal images, equal hashes, on any machine of one
/// endianness.
[[nodiscard]] std::uint64_t hash_of(const Image& image);
/// Largest resident set of this process, bytes.
[[nodiscard]] std::size_t peak_memory();

[[nodiscard]] std::string closing_table(const RunReport& report);
[[nodiscard]] std::string to_json(const RunReport& report, const Scene& scene);
/// `stop`: what may end the render before the scene's samples are used up.
[[nodiscard]] std::string explain(const Scene& scene, const Features& needed,
                                  const StopSettings& stop);

} // namespace plumb
