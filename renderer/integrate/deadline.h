/// \file  How many samples fit into the time that is left.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace plumb {

/// Cuts a render into passes: the first of one sample a pixel, each later one about half of what
/// the time left allows, judged by the speed of the one before. Without a limit one pass does all.
class Deadline {
  public:
    /// The time begins now. `limit_s`: 0 for none.
    explicit Deadline(double limit_s) : limit_s_(limit_s), start_(Clock::now()) {}

    [[nodiscard]] double share_used() const { return limit_s_ > 0 ? elapsed_s() / limit_s_ : 0; }

    /// How far `pixels` pixels with `n` samples each can go: at most to `wanted`; `n` if no
    /// further. Begins the pass.
    [[nodiscard]] std::uint32_t reachable(std::uint32_t n, std::uint32_t wanted, double pixels) {
        if (!(limit_s_ > 0))
            return wanted;
        pass_start_s_ = elapsed_s();
        std::uint32_t end = std::min(wanted, n + 1);
        if (sample_s_ > 0) {
            const double fit = (limit_s_ - pass_start_s_) / (sample_s_ * pixels);
            const double steps = fit >= 1 ? std::max(1.0, 0.5 * fit) : 0;
            end = n + static_cast<std::uint32_t>(std::min<double>(wanted - n, steps));
        }
        pass_samples_ = pixels * (end - n);
        return end;
    }

    /// Ends the pass.
    void passed() {
        if (limit_s_ > 0)
            sample_s_ = (elapsed_s() - pass_start_s_) / pass_samples_;
    }

  private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] double elapsed_s() const {
        return std::chrono::duration<double>(Clock::now() - start_).count();
    }

    double limit_s_;
    Clock::time_point start_;
    double sample_s_ = 0; ///< of one sample of one pixel, all threads; 0: not known
    double pass_start_s_ = 0, pass_samples_ = 0;
};

} // namespace plumb
