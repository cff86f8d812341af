/// \file  Parsing of colours and lists of numbers.
#include "renderer/io/colour_value.h"

#include "renderer/io/parse_number.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

namespace plumb {
namespace {

constexpr std::string_view separators = " \t\r\n,";

std::vector<std::string_view> split(std::string_view text) {
    std::vector<std::string_view> tokens;
    for (std::size_t start = text.find_first_not_of(separators); start != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(separators, start), text.size());
        tokens.push_back(text.substr(start, end - start));
        start = text.find_first_not_of(separators, end);
    }
    return tokens;
}

template <class Number, class Parse>
std::vector<Number> parse_list(const XmlNode& node, const XmlAttribute& attribute, Parse parse) {
    std::vector<Number> numbers;
    for (const std::string_view token : split(attribute.value)) {
        const std::optional<Number> number = parse(token);
        if (!number)
            node.refuse(attribute, fmt::format("bad number in '{}' of <{}> (got '{:.40}', expected "
                                               "a finite decimal number)",
                                               attribute.name, node.name, token));
        numbers.push_back(*number);
    }
    return numbers;
}

std::optional<Rgb> parse_hex(std::string_view text) {
    if (text.size() != 7 || text[0] != '#')
        return std::nullopt;
    std::uint32_t code = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data() + 1, last, code, 16);
    if (end != last || error != std::errc{})
        return std::nullopt;
    const auto channel = [&](unsigned shift) {
        return srgb_to_linear(static_cast<float>((code >> shift) & 0xFFu) / 255.0f);
    };
    return Rgb{channel(16), channel(8), channel(0)};
}

std::string_view trimmed(std::string_view text) {
    const std::size_t start = text.find_first_not_of(separators);
    if (start == std::string_view::npos)
        return {};
    return text.substr(start, text.find_last_not_of(separators) - start + 1);
}

Rgb parse_rgb(const XmlNode& element, const XmlAttribute& value) {
    const bool encoded = element.name == "srgb";
    const std::string_view text = trimmed(value.value);
    if (text.starts_with('#')) {
        const auto colour = parse_hex(text);
        if (!colour)
            element.refuse(value, fmt::format("bad colour (got '{:.40}', expected #rrggbb)", text));
        return *colour;
    }
    std::vector<float> c = parse_floats(element, value);
    if (c.size() != 1 && c.size() != 3)
        element.refuse(
            value, fmt::format("bad colour (got {} numbers, expected 3, 1 or #rrggbb)", c.size()));
    c.resize(3, c[0]);
    if (encoded)
        std::transform(c.begin(), c.end(), c.begin(), srgb_to_linear);
    return {c[0], c[1], c[2]};
}

} // namespace

std::vector<float> parse_floats(const XmlNode& node, const XmlAttribute& attribute) {
    return parse_list<float>(node, attribute, parse_float);
}

std::vector<double> parse_doubles(const XmlNode& node, const XmlAttribute& attribute) {
    return parse_list<double>(node, attribute, parse_double);
}

bool is_colour_element(std::string_view element) {
    return element == "rgb" || element == "srgb" || element == "color" || element == "spectrum" ||
           element == "float";
}

std::optional<Rgb> parse_colour(const XmlNode& element) {
    const XmlAttribute& value = element.require("value");
    if (element.name == "rgb" || element.name == "srgb" || element.name == "color")
        return parse_rgb(element, value);
    if (value.value.find(':') != std::string_view::npos)
        return std::nullopt;
    const std::vector<float> numbers = parse_floats(element, value);
    if (numbers.size() != 1)
        element.refuse(value, fmt::format("bad value of <{}> (got {} numbers, expected one)",
                                          element.name, numbers.size()));
    return Rgb{numbers[0], numbers[0], numbers[0]};
}

float mean_of_spectrum(const XmlNode& element) {
    const XmlAttribute& value = element.require("value");
    double sum = 0;
    const std::vector<std::string_view> pairs = split(value.value);
    for (const std::string_view pair : pairs) {
        const std::size_t colon = pair.find(':');
        const auto number =
            colon == std::string_view::npos ? std::nullopt : parse_float(pair.substr(colon + 1));
        if (!number || !parse_float(pair.substr(0, colon)))
            element.refuse(value, fmt::format("bad spectrum (got '{:.40}', expected pairs "
                                              "wavelength:value)",
                                              pair));
        sum += static_cast<double>(*number);
    }
    return static_cast<float>(sum / static_cast<double>(pairs.size()));
}

} // namespace plumb
