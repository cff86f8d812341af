/// \file  "Did you mean ...?" for messages about unknown names.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace plumb {

/// The candidate with the smallest edit distance (insert, delete, replace, swap of neighbours) to
/// `name`, the first of equals; empty if none is within a third of the name's length plus one.
[[nodiscard]] std::string_view nearest_name(std::string_view name,
                                            std::span<const std::string_view> candidates);

/// ` (did you mean 'X'?)`, or nothing.
[[nodiscard]] std::string did_you_mean(std::string_view name,
                                       std::span<const std::string_view> candidates);
[[nodiscard]] std::string did_you_mean(std::string_view name,
                                       std::initializer_list<std::string_view> candidates);

} // namespace plumb
