/// \file  Runs a program as a user does.
#pragma once

#include <string>

namespace plumb::test {

/// What a run printed (stdout and stderr together) and how it ended: 128 + n after signal n.
struct CommandOutcome {
    int exit_code = -1;
    std::string output;
};

/// Runs a line of shell.
[[nodiscard]] CommandOutcome run_command(const std::string& line);

} // namespace plumb::test
