/// \file  One XML file in memory: UTF-8 text that knows its line numbers.
#pragma once

#include "renderer/scene/error.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace plumb {

/// The text of one file. Parsing edits `text` in place; `line_starts` was taken before and stays.
struct XmlText {
    std::string file; ///< as messages show it
    std::string text; ///< UTF-8 without a byte order mark
    std::vector<std::uint32_t> line_starts;
    std::vector<SourceLocation> included_from; ///< innermost first

    /// Line and column (in bytes, from 1) of a byte of the text.
    [[nodiscard]] SourceLocation at(std::size_t offset) const;
    /// Throws SceneError(scene) at a byte of the text.
    [[noreturn]] void refuse(std::size_t offset, const std::string& what) const;
};

/// Control characters, which a message must not carry to a terminal, become `?`.
[[nodiscard]] std::string one_line(std::string text);

/// Largest scene file: 1 GiB (meshes belong in files of their own).
inline constexpr std::uint64_t max_xml_bytes = std::uint64_t{1} << 30;

/// Reads a file and converts UTF-16 with a byte order mark to UTF-8. Throws SceneError(scene):
/// missing or unreadable file, NUL and other control characters, bad UTF-8 or UTF-16.
[[nodiscard]] XmlText read_xml_text(const std::filesystem::path& file,
                                    const std::vector<SourceLocation>& included_from = {});

} // namespace plumb
