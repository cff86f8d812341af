/// \file  Substitution of `$parameter`.
#include "renderer/io/xml_parameters.h"

#include "renderer/io/nearest_name.h"
#include "renderer/io/xml_lint.h"

#include <algorithm>
#include <fmt/format.h>

namespace plumb {
namespace {

bool is_parameter_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// The name at the start of `text`.
std::string_view leading_name(std::string_view text) {
    const auto end = std::find_if_not(text.begin(), text.end(), is_parameter_character);
    return text.substr(0, static_cast<std::size_t>(end - text.begin()));
}

} // namespace

XmlParameters::XmlParameters(
    const std::vector<std::pair<std::string, std::string>>& from_command_line) {
    for (const auto& [name, value] : from_command_line)
        parameters_[name] = {value, true, false};
}

void XmlParameters::define(const XmlNode& element) {
    element.allow_only({"name", "value"});
    const XmlAttribute& name = element.require("name");
    const XmlAttribute& value = element.require("value");
    if (name.value.empty() || leading_name(name.value) != name.value)
        element.refuse(name, fmt::format("bad parameter name (got '{}', expected letters, digits "
                                         "and _)",
                                         name.value));
    if (!parameters_.contains(name.value))
        parameters_[std::string(name.value)] = {expanded(element, value), false, false};
}

std::string XmlParameters::expanded(const XmlNode& node, const XmlAttribute& attribute) {
    std::string text;
    std::string_view rest = attribute.value;
    for (std::size_t dollar = rest.find('$'); dollar != std::string_view::npos;
         dollar = rest.find('$')) {
        text += rest.substr(0, dollar);
        const std::string_view name = leading_name(rest.substr(dollar + 1));
        const auto found = parameters_.find(name);
        if (found == parameters_.end()) {
            std::vector<std::string_view> names;
            for (const auto& [known, parameter] : parameters_)
                names.push_back(known);
            node.refuse(
                attribute,
                fmt::format("undefined parameter '${}'{} (give it a <default> or -D {}=...)", name,
                            did_you_mean(name, names), name));
        }
        found->second.used = true;
        text += found->second.value;
        // Defaults made of defaults could double at each step.
        if (text.size() > max_xml_value)
            node.refuse(attribute, fmt::format("value too long after putting in parameters "
                                               "(expected at most {} bytes)",
                                               max_xml_value));
        rest.remove_prefix(dollar + 1 + name.size());
    }
    return text += rest;
}

void XmlParameters::substitute(XmlNode& node, std::deque<std::string>& pool) {
    for (XmlAttribute& attribute : node.attributes)
        if (attribute.value.find('$') != std::string_view::npos)
            attribute.value = pool.emplace_back(expanded(node, attribute));
}

std::vector<std::string> XmlParameters::unused() const {
    std::vector<std::string> names;
    for (const auto& [name, parameter] : parameters_)
        if (parameter.from_command_line && !parameter.used)
            names.push_back(name);
    return names;
}

} // namespace plumb
