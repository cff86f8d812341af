/// \file  Any lines as a command line.

#include "renderer/options.h"
#include "tests/fuzz/finding.h"
#include "tests/fuzz/fuzz_targets.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace plumb::fuzz {
namespace {

/// The program's name and one argument a line, as the shell would pass them: without NUL.
std::vector<std::string> arguments_in(std::string_view text) {
    std::vector<std::string> arguments{"renderer"};
    while (!text.empty() && arguments.size() < 64) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        arguments.emplace_back(line.substr(0, line.find('\0')));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return arguments;
}

/// The ranges that --help states.
void require_in_range(const Options& options) {
    require(options.threads >= 0 && options.threads <= 1024, "--threads out of range");
    require(options.spp.value_or(1) >= 1, "--spp out of range");
    require(options.rr_depth.value_or(1) >= 1, "--rr-depth out of range");
    require(options.max_depth.value_or(-1) >= -1, "--max-depth out of range");
    const float p = options.roulette_constant.value_or(1);
    require(p > 0 && p <= 1, "--rr out of range");
    require(std::fabs(options.outputs.exposure) <= 100, "--exposure out of range");
    require(options.stop.target_error >= 0 && options.stop.target_error <= 1,
            "--target-error out of range");
    require(options.stop.time_limit_s >= 0 && options.stop.time_limit_s <= 1e9,
            "--time-limit out of range");
    require(!options.scene.file.empty(), "no scene");
    require(options.validate != options.accel, "--validate compares one with itself");
}

} // namespace

int fuzz_command_line(const std::uint8_t* data, std::size_t size) {
    const std::string text(data, data + size);
    const std::vector<std::string> arguments = arguments_in(text);
    std::vector<const char*> argv;
    for (const std::string& argument : arguments)
        argv.push_back(argument.c_str());
    const ParsedOptions parsed = parse_options(static_cast<int>(argv.size()), argv.data());
    if (parsed.options) {
        require_in_range(*parsed.options);
        Scene scene;
        apply_options(*parsed.options, scene);
        require(scene.sampler.spp >= 1, "a scene without samples");
    } else if (parsed.exit_code == 0) {
        require(!parsed.text.empty(), "an empty answer");
    } else {
        require(parsed.exit_code == 2, "a usage error that is none");
        require(parsed.text.starts_with("error: "), "a usage error without a word");
        require(std::count(parsed.text.begin(), parsed.text.end(), '\n') == 1 &&
                    parsed.text.back() == '\n',
                "a usage error that is not one line");
        require(std::none_of(parsed.text.begin(), parsed.text.end() - 1,
                             [](char c) { return (c >= 0 && c < ' ') || c == 0x7F; }),
                "a usage error with control characters");
    }
    return 0;
}

} // namespace plumb::fuzz
