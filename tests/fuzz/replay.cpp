/// \file  Runs a fuzz target over the files of its corpus: what it found once stays found.
///
///     fuzz_replay TARGET FILE|FOLDER...
///
/// Prints each file that fails and how many were run. Exit code 1 if one fails or there is none; a
/// crash names the file on stderr.

#include "tests/fuzz/finding.h"
#include "tests/fuzz/fuzz_targets.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace plumb::fuzz {
namespace {

namespace fs = std::filesystem;

struct Target {
    std::string_view name;
    int (*run)(const std::uint8_t* data, std::size_t size);
};
constexpr Target targets[] = {{"scene_xml", fuzz_scene_xml},
                              {"obj", fuzz_obj},
                              {"ply", fuzz_ply},
                              {"command_line", fuzz_command_line},
                              {"intersectors", fuzz_intersectors}};

char current_file[4096] = "";

extern "C" void name_the_file(int signal_number) {
    const auto say = [](const char* text) {
        static_cast<void>(!::write(STDERR_FILENO, text, std::strlen(text)));
    };
    say("crashed on ");
    say(current_file);
    say("\n");
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
}

std::vector<fs::path> files_of(int count, const char* const* names) {
    std::vector<fs::path> files;
    for (int i = 0; i < count; ++i) {
        if (!fs::is_directory(names[i])) {
            files.emplace_back(names[i]);
            continue;
        }
        for (const fs::directory_entry& entry : fs::directory_iterator(names[i]))
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

bool passes(const Target& target, const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    const std::vector<char> text{std::istreambuf_iterator<char>(in), {}};
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    std::snprintf(current_file, sizeof current_file, "%s", file.c_str());
    try {
        return target.run(bytes.data(), bytes.size()) == 0;
    } catch (const std::exception& error) {
        std::printf("%s: %s\n", file.c_str(), error.what());
        return false;
    }
}

} // namespace
} // namespace plumb::fuzz

int main(int argc, char** argv) {
    using namespace plumb::fuzz;
    const std::string_view name = argc > 1 ? argv[1] : "";
    const auto* const target = std::find_if(std::begin(targets), std::end(targets),
                                            [&](const Target& t) { return t.name == name; });
    if (target == std::end(targets) || argc < 3) {
        std::fprintf(stderr, "usage: fuzz_replay TARGET FILE|FOLDER...\n");
        return 2;
    }
    for (const int signal_number : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL})
        std::signal(signal_number, name_the_file);
    const std::vector<std::filesystem::path> files = files_of(argc - 2, argv + 2);
    const auto failed = std::count_if(files.begin(), files.end(),
                                      [&](const auto& file) { return !passes(*target, file); });
    std::printf("%zu files, %td failed\n", files.size(), failed);
    return failed == 0 && !files.empty() ? 0 : 1;
}
