/// \file  When a render ends before its samples are used up, and what it had reached.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace plumb {

/// Samples per pixel where error or time end a render and nothing else is said: the random numbers
/// have 24 bits, a Sobol' dimension has no new ones after so many.
inline constexpr std::uint32_t spp_without_bound = 1u << 24;

/// Fewest samples per pixel with which an error can be estimated: two in each half.
inline constexpr std::uint32_t fewest_spp_of_target = 4;

struct StopSettings {
    double target_error = 0; ///< relative error of pixel_error.h; 0: no target
    double time_limit_s = 0; ///< of rendering; 0: no limit

    [[nodiscard]] bool any() const { return target_error > 0 || time_limit_s > 0; }
};

enum class StoppedBy : std::uint8_t { spp, target_error, time_limit, signal };

[[nodiscard]] constexpr std::string_view name_of(StoppedBy what) {
    switch (what) {
    case StoppedBy::spp: return "spp";
    case StoppedBy::target_error: return "target-error";
    case StoppedBy::time_limit: return "time-limit";
    case StoppedBy::signal: return "signal";
    }
    return "";
}

/// What a render with StopSettings had when it ended.
struct Reached {
    double error = 0; ///< relative error of the image (pixel_error.h); infinite if unknown
    std::uint32_t spp_min = 0, spp_max = 0; ///< samples that are in a pixel
    double spp_mean = 0;
};

} // namespace plumb
