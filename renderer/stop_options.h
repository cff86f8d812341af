/// \file  The command line of --target-error and --time-limit.
#pragma once

#include "renderer/integrate/stopping.h"

#include <optional>
#include <string_view>

namespace CLI {
class App;
}

namespace plumb {

struct Options;

/// Seconds of a time such as 30s, 500ms, 2m, 1.5h or 10 (seconds); nothing unless it is above 0
/// and at most 1e9 s.
[[nodiscard]] std::optional<double> parse_time(std::string_view text);

/// `stop` must outlive the parsing.
void add_stop_flags(CLI::App& app, StopSettings& stop);

/// Throws CLI::ValidationError where these flags contradict others.
void check_stop_flags(const Options& options);

} // namespace plumb
