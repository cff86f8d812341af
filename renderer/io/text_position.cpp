/// \file  Where a byte of a text is, and how to quote a piece of it in a message.
#include "renderer/io/text_position.h"

#include <algorithm>
#include <limits>

namespace plumb {
namespace {

int to_int(std::size_t n) {
    constexpr std::size_t most = std::numeric_limits<int>::max();
    return static_cast<int>(std::min(n, most));
}

} // namespace

SourceLocation locate(const std::string& file, std::string_view text, std::size_t offset) {
    const std::string_view before = text.substr(0, offset);
    const std::size_t newline = before.rfind('\n');
    const std::size_t line_start = newline == std::string_view::npos ? 0 : newline + 1;
    const auto lines = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
    return {file, to_int(lines + 1), to_int(before.size() - line_start + 1)};
}

std::string printable(std::string_view token) {
    constexpr std::size_t longest = 40;
    std::string text(token.substr(0, longest));
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    if (token.size() > longest)
        text += "...";
    return text;
}

} // namespace plumb
