/// \file  The values in the body of a PLY file, one after the other: ASCII and binary.
#pragma once

#include "renderer/io/ply_header.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace plumb {

// Both readers have the same interface, so that read_ply is written once: begin_row, then the
// values of the row in order, then end_row. All refuse with SceneError(ErrorKind::mesh). A place is
// what refuse_at takes.

/// One row a line. Errors carry line and column.
class PlyAsciiBody {
  public:
    /// `text` stands at the last line of the header.
    explicit PlyAsciiBody(LineCursor& text) : text_(text) {}

    /// Goes to the next line that is not empty.
    void begin_row();
    void end_row() { text_.expect_line_end("the end of the row"); }
    /// Finite and of at most max_coordinate.
    [[nodiscard]] float number(PlyType) { return text_.read_float(); }
    [[nodiscard]] long long integer(PlyType type);
    void skip(PlyType type, std::uint64_t count);

    [[nodiscard]] const char* place();
    [[noreturn]] void refuse_at(const char* place, const std::string& what) {
        text_.refuse(place, what);
    }
    /// Bytes after the last row that are not blank.
    [[nodiscard]] std::size_t trailing_bytes();

  private:
    LineCursor& text_;
};

/// Packed values. Errors carry the position in bytes from the start of the file.
class PlyBinaryBody {
  public:
    PlyBinaryBody(std::string file, std::string_view text, std::string_view body, PlyFormat format);

    void begin_row() {}
    void end_row() {}
    [[nodiscard]] float number(PlyType type);
    [[nodiscard]] long long integer(PlyType type);
    void skip(PlyType type, std::uint64_t count);

    [[nodiscard]] const char* place() const { return at_; }
    [[noreturn]] void refuse_at(const char* place, const std::string& what) const;
    [[nodiscard]] std::size_t trailing_bytes() const { return left(); }

  private:
    [[nodiscard]] std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
    template <class Value> [[nodiscard]] Value take();

    std::string file_;
    const char* start_; ///< of the file
    const char* at_;
    const char* end_;
    bool swap_bytes_;
};

} // namespace plumb
