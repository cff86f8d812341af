#include "tests/support/shared_scene.h"

#include <cstdlib>
#include <fmt/format.h>

#include <unistd.h>

namespace plumb::test {

namespace fs = std::filesystem;

std::optional<fs::path> unpacked_scene(const fs::path& archives, const std::string& scene,
                                       const fs::path& target) {
    const fs::path done = target / scene, archive = archives / (scene + ".tar.xz");
    if (fs::is_directory(done))
        return done;
    if (!fs::exists(archive))
        return std::nullopt;
    // Into a folder of this process first: the last step, a rename, is atomic.
    const fs::path mine = target / fmt::format(".{}.{}", scene, ::getpid());
    fs::create_directories(mine);
    const std::string command =
        fmt::format("tar -xJf '{}' -C '{}' --no-same-owner", archive.string(), mine.string());
    std::error_code error;
    if (std::system(command.c_str()) == 0) // NOLINT(concurrency-mt-unsafe)
        fs::rename(mine / scene, done, error);
    fs::remove_all(mine, error);
    if (fs::is_directory(done))
        return done;
    return std::nullopt;
}

} // namespace plumb::test
