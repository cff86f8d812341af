#include "tools/bench_src/progress.h"

#include <cstdio>
#include <fmt/format.h>
#include <unistd.h>

namespace plumb::bench {

Progress::Progress(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
    if (shown_)
        fmt::print(stderr, "\r\x1b[K");
}

void Progress::stage(const std::string& what) {
    stage_ = what;
    if (quiet_)
        return;
    if (terminal_)
        show(what);
    else
        fmt::print(stderr, "{}\n", what);
}

void Progress::detail(const std::string& what) {
    if (!quiet_ && terminal_)
        show(stage_ + ": " + what);
}

void Progress::show(const std::string& line) {
    shown_ = true;
    constexpr std::size_t columns = 100;
    fmt::print(stderr, "\r\x1b[K{}", line.substr(0, columns));
    std::fflush(stderr);
}

} // namespace plumb::bench
