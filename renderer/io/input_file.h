/// \file  Whole files in memory, for every reader of text and meshes.
#pragma once

#include "renderer/scene/error.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

/// Largest input that is read at all: 16 GiB.
inline constexpr std::uint64_t max_input_bytes = std::uint64_t{1} << 34;

/// The bytes of a regular file as they are. The size is known and checked before anything is
/// allocated. Throws SceneError(kind), located at the file alone, where it is missing, unreadable,
/// larger than `max_bytes`, or no regular file (a directory, a device, a pipe: they have no size to
/// check, and a pipe may never end). An empty file gives an empty string. Thread-safe.
/// \param included_from  places that named the file, innermost first, for the message
[[nodiscard]] std::string read_file(const std::filesystem::path& file, ErrorKind kind,
                                    std::uint64_t max_bytes = max_input_bytes,
                                    const std::vector<SourceLocation>& included_from = {});

/// The bytes of a regular file, mapped and read-only: a large mesh is paged in as it is parsed, and
/// a refusal near its start costs nothing. Refuses what read_file refuses. A file that another
/// process cuts short while it is mapped raises SIGBUS.
class MappedFile {
  public:
    MappedFile(const std::filesystem::path& file, ErrorKind kind);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;
    [[nodiscard]] std::string_view text() const { return text_; }

  private:
    std::string_view text_;
};

} // namespace plumb
