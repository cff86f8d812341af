/// \file  Reference scenes that lie beside the project, where they do.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace plumb::test {

/// Folder of `scene`, unpacked once below `target` from `archives`/`scene`.tar.xz. Empty where
/// there is no such archive or it cannot be unpacked. Safe to call from several processes at once.
[[nodiscard]] std::optional<std::filesystem::path>
unpacked_scene(const std::filesystem::path& archives, const std::string& scene,
               const std::filesystem::path& target);

} // namespace plumb::test
