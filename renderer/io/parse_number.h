/// \file  Numbers from whole tokens, the same in every locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace plumb {

/// The number that `token` is, or nothing unless all of it is one decimal number that fits: no
/// white space around it, no `1,5`, `12abc`, `0x10`, nan or inf, no overflow (1e999, or 1e39 as a
/// float), no sign on an unsigned type but a `+`. A leading `+` is accepted. Floating-point numbers
/// are the nearest representable; those too small for the type give a subnormal number or zero.
[[nodiscard]] std::optional<float> parse_float(std::string_view token);
[[nodiscard]] std::optional<double> parse_double(std::string_view token);
[[nodiscard]] std::optional<std::int32_t> parse_int32(std::string_view token);
[[nodiscard]] std::optional<std::int64_t> parse_int64(std::string_view token);
[[nodiscard]] std::optional<std::uint32_t> parse_uint32(std::string_view token);
[[nodiscard]] std::optional<std::uint64_t> parse_uint64(std::string_view token);

} // namespace plumb
