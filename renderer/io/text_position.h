/// \file  Where a byte of a text is, and how to quote a piece of it in a message.
#pragma once

#include "renderer/scene/error.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace plumb {

/// Line and column (in bytes) of text[offset], both from 1. Counted on demand, at some 10 GB/s, so
/// that parsers need not track lines. Beyond 2^31 - 1 they stay there.
[[nodiscard]] SourceLocation locate(const std::string& file, std::string_view text,
                                    std::size_t offset);

/// `token` for a message of one line: at most 40 bytes, then `...`; other than printable ASCII
/// becomes `?`.
[[nodiscard]] std::string printable(std::string_view token);

} // namespace plumb
