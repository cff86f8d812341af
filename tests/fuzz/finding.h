/// \file  What a fuzz target throws when the code under test is wrong.
#pragma once

#include <stdexcept>
#include <string>

namespace plumb::fuzz {

/// libFuzzer has no handler for it, so that it ends the process with the stack still standing.
class Finding : public std::logic_error {
  public:
    using std::logic_error::logic_error;
};

inline void require(bool condition, const char* what) {
    if (!condition)
        throw Finding(what);
}
inline void require(bool condition, const std::string& what) { require(condition, what.c_str()); }

} // namespace plumb::fuzz
