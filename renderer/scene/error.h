/// \file  The one exception of loading and writing.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace plumb {

/// Process exit codes (README lists them). The value of an error is its exit code.
enum class ErrorKind : int { usage = 2, scene = 3, mesh = 4, output = 5, resources = 6 };

/// A place in an input file. Line and column count from 1; 0: unknown (left out of messages).
struct SourceLocation {
    std::string file;
    int line = 0;
    int column = 0;
};

/// what() is the whole message: `FILE:LINE:COL: error: what (got 'X', expected Y)` and below it one
/// line `  included from FILE:LINE:COL` for each enclosing file.
class SceneError : public std::runtime_error {
  public:
    SceneError(ErrorKind kind, const SourceLocation& where, const std::string& what,
               const std::vector<SourceLocation>& included_from = {});
    [[nodiscard]] ErrorKind kind() const { return kind_; }
    [[nodiscard]] int exit_code() const { return static_cast<int>(kind_); }

  private:
    ErrorKind kind_;
};

/// `FILE:LINE:COL`, without the parts that are unknown.
[[nodiscard]] std::string to_string(const SourceLocation& where);

} // namespace plumb
