/// \file  The plugins that Mitsuba has, to tell a wrong name from one not supported yet.
#pragma once

#include <span>
#include <string_view>

namespace plumb {

/// Names for the `type` of an element such as `bsdf`, of Mitsuba 0.6 and 3; empty for an element
/// that is no object.
[[nodiscard]] std::span<const std::string_view> known_plugins(std::string_view element);

/// The elements of scene files that are objects with a `type`.
[[nodiscard]] std::span<const std::string_view> object_elements();

} // namespace plumb
