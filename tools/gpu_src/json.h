/// \file  Just enough JSON to write numbers.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace plumb::gpu {

[[nodiscard]] inline std::string json_text(std::string_view value) {
    std::string out = "\"";
    for (const char c : value) {
        if (c == '"' || c == '\\')
            out += '\\';
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return out + "\"";
}

[[nodiscard]] inline std::string json_number(double value) {
    if (!std::isfinite(value))
        return "null";
    char text[32];
    std::snprintf(text, sizeof(text), "%.6g", value);
    return text;
}

/// Members of an object, or elements of an array, joined in brackets.
[[nodiscard]] inline std::string json_joined(const std::vector<std::string>& parts, char open,
                                             char close, std::string_view separator = ", ") {
    std::string out(1, open);
    for (std::size_t i = 0; i < parts.size(); ++i)
        out += (i > 0 ? std::string(separator) : std::string()) + parts[i];
    return out + close;
}

[[nodiscard]] inline std::string json_member(std::string_view key, const std::string& value) {
    return json_text(key) + ": " + value;
}

} // namespace plumb::gpu
