#include "renderer/scene/error.h"

namespace plumb {
namespace {

std::string message(const SourceLocation& where, const std::string& what,
                    const std::vector<SourceLocation>& included_from) {
    std::string text = to_string(where);
    text += text.empty() ? "error: " : ": error: ";
    for (const char c : what) // a file's own text may be quoted, &#13; and all
        text += (c >= 0 && c < ' ' && c != '\n') || c == 0x7F ? '?' : c;
    for (const SourceLocation& outer : included_from)
        text += "\n  included from " + to_string(outer);
    return text;
}

} // namespace

SceneError::SceneError(ErrorKind kind, const SourceLocation& where, const std::string& what,
                       const std::vector<SourceLocation>& included_from)
    : std::runtime_error(message(where, what, included_from)), kind_(kind) {}

std::string to_string(const SourceLocation& where) {
    std::string text = where.file;
    if (where.line > 0)
        text.append(1, ':').append(std::to_string(where.line));
    if (where.line > 0 && where.column > 0)
        text.append(1, ':').append(std::to_string(where.column));
    return text;
}

} // namespace plumb
