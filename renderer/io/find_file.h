/// \file  Finding the files that a scene names.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

namespace plumb {

/// The first existing `folder / name` (or `name` itself if absolute); where there is none, the
/// first that exists but for the case of ASCII letters, as scenes made on Windows need. Backslashes
/// in `name` separate folders.
[[nodiscard]] std::optional<std::filesystem::path>
find_file(std::string_view name, std::span<const std::filesystem::path> folders);

} // namespace plumb
