/// \file  A scene file with everything it includes, as one tree.
#pragma once

#include "renderer/io/xml_node.h"

#include <deque>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace plumb {

inline constexpr std::size_t max_include_depth = 15;
inline constexpr std::size_t max_includes = 1000; ///< in all: includes of includes could double

/// The nodes point into `files` and `strings`, which never move.
struct XmlDocument {
    std::deque<XmlText> files;
    std::deque<std::string> strings; ///< values with parameters put in
    XmlNode root;                    ///< <scene>, without <default>, <include> and <path>
    /// Where files are looked up: the folder of the scene, then those of <path>, the last first.
    std::vector<std::filesystem::path> folders;
    std::vector<std::string> warnings;
};

/// Reads `file`, puts in included files and parameters in the order of the text, and checks the
/// versions. Throws SceneError.
[[nodiscard]] XmlDocument
load_xml_document(const std::filesystem::path& file,
                  const std::vector<std::pair<std::string, std::string>>& parameters);

} // namespace plumb
