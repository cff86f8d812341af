#include "renderer/stop_options.h"

#include "renderer/io/parse_number.h"
#include "renderer/options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace plumb {

std::optional<double> parse_time(std::string_view text) {
    struct Unit {
        std::string_view name;
        double seconds;
    };
    constexpr Unit units[] = {{"ms", 1e-3}, {"s", 1}, {"m", 60}, {"h", 3600}}; // "ms" before "s"
    double scale = 1;
    for (const Unit& unit : units)
        if (text.ends_with(unit.name)) {
            text.remove_suffix(unit.name.size());
            scale = unit.seconds;
            break;
        }
    const auto number = parse_double(text);
    if (!number || !(*number > 0) || !(*number * scale <= 1e9))
        return std::nullopt;
    return *number * scale;
}

void add_stop_flags(CLI::App& app, StopSettings& stop) {
    app.add_option_function<std::string>(
           "--target-error",
           [&stop](const std::string& text) {
               const auto error = parse_double(text);
               if (!error || !(*error > 0 && *error <= 1))
                   throw CLI::ValidationError(
                       "--target-error",
                       fmt::format("bad error (got '{}', expected above 0 to 1)", text));
               stop.target_error = *error;
           },
           "Sample each pixel until the 95 % confidence interval of its luminance is within this "
           "share of it (of a tenth of the image's mean, if that is more); ends when 99 % of the "
           "pixels are")
        ->type_name("SHARE");
    app.add_option_function<std::string>(
           "--time-limit",
           [&stop](const std::string& text) {
               const auto limit_s = parse_time(text);
               if (!limit_s)
                   throw CLI::ValidationError(
                       "--time-limit",
                       fmt::format("bad time (got '{}', expected above 0 as in 500ms, 30s, 2m, 1h)",
                                   text));
               stop.time_limit_s = *limit_s;
           },
           "End rendering (loading and building do not count) after this time, with at least one "
           "sample a pixel")
        ->type_name("TIME");
}

void check_stop_flags(const Options& options) {
    const StopSettings& stop = options.stop;
    if (stop.any() && options.device == Device::cuda)
        throw CLI::ValidationError(stop.target_error > 0 ? "--target-error" : "--time-limit",
                                   "needs --device=cpu");
    if (stop.target_error > 0 && options.spp.value_or(fewest_spp_of_target) < fewest_spp_of_target)
        throw CLI::ValidationError("--target-error",
                                   fmt::format("needs more samples (got --spp '{}', expected at "
                                               "least {})",
                                               *options.spp, fewest_spp_of_target));
    if (stop.target_error > 0 && options.variance)
        throw CLI::ValidationError(
            "--variance", "contradicts --target-error: pixels differ in their number of samples");
}

} // namespace plumb
