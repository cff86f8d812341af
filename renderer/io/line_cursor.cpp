/// \file  A text of lines of numbers, as OBJ and ASCII PLY files are: the place where one reads.
#include "renderer/io/line_cursor.h"

#include "accel/math/vec.h"
#include "renderer/io/parse_number.h"
#include "renderer/io/text_position.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <system_error>
#include <utility>

namespace plumb {
namespace {

constexpr std::ptrdiff_t max_line_bytes = std::ptrdiff_t{1} << 25;
constexpr const char* too_long = "line is too long (expected at most 32 MiB)";

} // namespace

LineCursor::LineCursor(std::string file, std::string_view text)
    : file_(std::move(file)), text_(text), at_(text.data()), end_(at_ + text.size()),
      line_end_(at_), next_line_(at_) {
    if (text_.substr(0, 3) == "\xef\xbb\xbf")
        next_line_ += 3;
}

bool LineCursor::next_line() {
    at_ = next_line_;
    line_end_ = at_;
    if (at_ == end_)
        return false;
    line_end_ = physical_line_end(at_);
    next_line_ = line_end_ == end_ ? end_ : line_end_ + 1;
    return true;
}

const char* LineCursor::physical_line_end(const char* from) const {
    const std::ptrdiff_t left = end_ - from;
    const auto span = static_cast<std::size_t>(std::min(left, max_line_bytes));
    const void* const newline = span > 0 ? std::memchr(from, '\n', span) : nullptr;
    if (newline != nullptr)
        return static_cast<const char*>(newline);
    if (left > max_line_bytes)
        refuse(from, too_long);
    return end_;
}

void LineCursor::join_continued_lines() {
    while (line_end_ != end_) {
        const char* last = line_end_ - 1;
        if (last > at_ && *last == '\r')
            --last;
        if (last < at_ || *last != '\\')
            break;
        line_end_ = physical_line_end(next_line_);
        next_line_ = line_end_ == end_ ? end_ : line_end_ + 1;
        if (line_end_ - at_ > max_line_bytes)
            refuse(at_, too_long);
    }
}

/// A backslash right before a newline that join_continued_lines took back, or before the end.
bool LineCursor::is_continuation(const char* p) const {
    if (*p != '\\')
        return false;
    ++p;
    if (p != line_end_ && *p == '\r')
        ++p;
    return p == line_end_ || *p == '\n';
}

std::string_view LineCursor::token_from(const char* from) const {
    const char* p = from;
    while (!is_separator(p))
        ++p;
    return {from, static_cast<std::size_t>(p - from)};
}

float LineCursor::read_float() {
    skip_space();
    float value = 0;
    const auto [stop, error] = std::from_chars(at_, line_end_, value);
    const bool ends_here = stop == line_end_ || is_space(*stop);
    if (error != std::errc{} || !ends_here || !(std::fabs(value) <= max_coordinate))
        return read_float_slowly();
    at_ = stop;
    return value;
}

/// What is rare, and what is wrong.
float LineCursor::read_float_slowly() {
    if (at_line_end())
        refuse("number is missing (got the end of the line)");
    const std::string_view text = token();
    const auto value = parse_float(text);
    if (!value)
        refuse("invalid number (got '" + printable(text) + "', expected a decimal number)");
    if (std::fabs(*value) > max_coordinate)
        refuse("number is too large (got '" + printable(text) + "', expected at most 1.8e18)");
    at_ += text.size();
    return *value;
}

std::optional<long long> LineCursor::read_integer() {
    long long value = 0;
    const auto [stop, error] = std::from_chars(at_, line_end_, value);
    if (error != std::errc{})
        return std::nullopt;
    at_ = stop;
    return value;
}

void LineCursor::expect_line_end(const char* expected) {
    if (!at_line_end())
        refuse("superfluous value (got '" + printable(token()) + "', expected " + expected + ")");
}

std::string_view LineCursor::rest() const {
    return {next_line_, static_cast<std::size_t>(end_ - next_line_)};
}

void LineCursor::refuse(const char* at, const std::string& what) const {
    const auto offset = static_cast<std::size_t>(at - text_.data());
    throw SceneError(ErrorKind::mesh, locate(file_, text_, offset), what);
}

int LineCursor::line_of(const char* at) const {
    return locate(file_, text_, static_cast<std::size_t>(at - text_.data())).line;
}

} // namespace plumb
