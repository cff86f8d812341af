/// \file  A text of lines of numbers, as OBJ and ASCII PLY files are: the place where one reads.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace plumb {

/// Walks over a text line by line and token by token. Lines end in LF or CRLF, the last one also
/// without; tokens are parted by blanks; `#` starts a comment. All errors are
/// SceneError(ErrorKind::mesh) at the line and column of `at()`.
class LineCursor {
  public:
    /// `text` must outlive the cursor. A UTF-8 byte order mark is skipped.
    LineCursor(std::string file, std::string_view text);

    /// Goes to the start of the next line; false where there is none. Refuses a line of more than
    /// 32 MiB, which would cost time: a face of a million corners is shorter.
    [[nodiscard]] bool next_line();
    /// From now on the line goes on where it ends in a backslash.
    void join_continued_lines();

    /// Skips blanks. True if nothing but a comment is left on the line.
    [[nodiscard]] bool at_line_end() {
        skip_space();
        return at_ == line_end_ || *at_ == '#';
    }
    /// At a blank, a comment or the end of the line.
    [[nodiscard]] bool at_separator() const { return is_separator(at_); }
    [[nodiscard]] char peek() const { return at_ != line_end_ ? *at_ : '\0'; }
    void advance(std::size_t bytes) { at_ += bytes; }
    [[nodiscard]] const char* at() const { return at_; }

    /// From `at()` to the next separator; not skipped.
    [[nodiscard]] std::string_view token() const { return token_from(at_); }
    [[nodiscard]] std::string_view token_from(const char* from) const;

    /// The next token on the line: a number of at most max_coordinate. \throws SceneError
    [[nodiscard]] float read_float();
    /// The decimal integer that starts right here, and skips it. Nothing, and nothing skipped,
    /// where there is none or one beyond 64 bits.
    [[nodiscard]] std::optional<long long> read_integer();
    /// \throws SceneError unless nothing is left on the line
    void expect_line_end(const char* expected);

    /// Everything from the start of the next line.
    [[nodiscard]] std::string_view rest() const;
    [[noreturn]] void refuse(const char* at, const std::string& what) const;
    [[noreturn]] void refuse(const std::string& what) const { refuse(at_, what); }
    [[nodiscard]] int line_of(const char* at) const;

  private:
    [[nodiscard]] static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
    [[nodiscard]] bool is_continuation(const char* p) const;
    [[nodiscard]] bool is_separator(const char* p) const {
        return p == line_end_ || is_space(*p) || *p == '#' || is_continuation(p);
    }
    void skip_space() {
        while (at_ != line_end_ && (is_space(*at_) || is_continuation(at_)))
            ++at_;
    }
    [[nodiscard]] const char* physical_line_end(const char* from) const;
    [[nodiscard]] float read_float_slowly();

    std::string file_;
    std::string_view text_;
    const char* at_;
    const char* end_;
    const char* line_end_;  ///< of the line being read: its LF, or the end of the text
    const char* next_line_; ///< start of the next line
};

} // namespace plumb
