/// \file  Named values that an image file carries beside its pixels.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace plumb {

/// In the order of writing. An EXR keeps the types; other formats keep what they have a place for.
using Metadata = std::vector<std::pair<std::string, std::variant<std::string, float, int>>>;

} // namespace plumb
