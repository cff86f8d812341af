#include "tests/support/run_command.h"

#include <array>
#include <cstdio>

#include <sys/wait.h>

namespace plumb::test {

CommandOutcome run_command(const std::string& line) {
    CommandOutcome run;
    FILE* pipe = ::popen(("( " + line + " ) 2>&1").c_str(), "r");
    if (pipe == nullptr)
        return run;
    std::array<char, 4096> buffer{};
    for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
        run.output.append(buffer.data(), n);
    const int status = ::pclose(pipe);
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return run;
}

} // namespace plumb::test
