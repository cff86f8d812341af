/// \file  Numbers from whole tokens by std::from_chars.
#include "renderer/io/parse_number.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace plumb {
namespace {

/// Without one leading `+`, which from_chars does not know. `+-1` stays as it is and fails later.
std::string_view without_plus(std::string_view token) {
    const bool plus = token.size() > 1 && token[0] == '+' && token[1] != '-';
    return plus ? token.substr(1) : token;
}

/// Whether a well-formed decimal number that is out of range is too small rather than too large:
/// the power of ten of its first significant digit is negative.
bool is_underflow(std::string_view number) {
    const std::size_t e = number.find_first_of("eE");
    const std::string_view mantissa = number.substr(0, e);
    long long exponent = 0;
    if (e != std::string_view::npos) {
        const std::string_view digits = without_plus(number.substr(e + 1));
        const auto [end, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
        if (error != std::errc{})
            return digits.front() == '-';
    }
    const std::size_t significant = mantissa.find_first_of("123456789");
    const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
    const auto place = static_cast<long long>(point) - static_cast<long long>(significant);
    // Far from overflow: out of range means beyond 1e37, so a few units more or less do not matter.
    return exponent < -place;
}

template <class Number> std::optional<Number> parse_floating(std::string_view token) {
    const std::string_view number = without_plus(token);
    const char* const last = number.data() + number.size();
    Number value = 0;
    const auto [end, error] = std::from_chars(number.data(), last, value);
    if (end != last || error == std::errc::invalid_argument)
        return std::nullopt;
    if (error == std::errc::result_out_of_range) {
        if (!is_underflow(number))
            return std::nullopt;
        return std::copysign(Number{0}, number.front() == '-' ? Number{-1} : Number{1});
    }
    if (!std::isfinite(value)) // from_chars reads `nan` and `inf`
        return std::nullopt;
    return value;
}

template <class Number> std::optional<Number> parse_integer(std::string_view token) {
    const std::string_view number = without_plus(token);
    const char* const last = number.data() + number.size();
    Number value = 0;
    const auto [end, error] = std::from_chars(number.data(), last, value);
    if (end != last || error != std::errc{})
        return std::nullopt;
    return value;
}

} // namespace

std::optional<float> parse_float(std::string_view token) { return parse_floating<float>(token); }
std::optional<double> parse_double(std::string_view token) { return parse_floating<double>(token); }
std::optional<std::int32_t> parse_int32(std::string_view token) {
    return parse_integer<std::int32_t>(token);
}
std::optional<std::int64_t> parse_int64(std::string_view token) {
    return parse_integer<std::int64_t>(token);
}
std::optional<std::uint32_t> parse_uint32(std::string_view token) {
    return parse_integer<std::uint32_t>(token);
}
std::optional<std::uint64_t> parse_uint64(std::string_view token) {
    return parse_integer<std::uint64_t>(token);
}

} // namespace plumb
