/// \file  Looking up file names, at last without regard to letter case.
#include "renderer/io/find_file.h"

#include <algorithm>
#include <string>
#include <system_error>

namespace plumb {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
    std::error_code ignored;
    return fs::exists(path, ignored);
}

bool same_letters(std::string_view a, std::string_view b) {
    const auto lower = [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [&](char x, char y) { return lower(x) == lower(y); });
}

/// The entry of `folder` that differs from `name` by letter case only; the first in order of name.
std::optional<fs::path> entry_like(const fs::path& folder, const std::string& name) {
    std::optional<fs::path> best;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const fs::path candidate = entry->path();
        if (same_letters(candidate.filename().string(), name) && (!best || candidate < *best))
            best = candidate;
    }
    return best;
}

std::optional<fs::path> find_in_any_case(const fs::path& folder, const fs::path& name) {
    fs::path path = name.is_absolute() ? name.root_path() : folder;
    for (const fs::path& part : name.relative_path()) {
        if (is_there(path / part)) {
            path /= part;
            continue;
        }
        const auto entry = entry_like(path.empty() ? fs::path(".") : path, part.string());
        if (!entry)
            return std::nullopt;
        path = path.empty() ? entry->filename() : *entry;
    }
    return path;
}

} // namespace

std::optional<fs::path> find_file(std::string_view name, std::span<const fs::path> folders) {
    std::string slashes(name);
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    const fs::path path(slashes);
    if (path.empty())
        return std::nullopt;
    for (const fs::path& folder : folders) // an absolute right-hand side replaces the folder
        if (is_there(folder / path))
            return folder / path;
    for (const fs::path& folder : folders)
        if (const auto found = find_in_any_case(folder, path))
            return found;
    return std::nullopt;
}

} // namespace plumb
