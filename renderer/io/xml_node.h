/// \file  The elements of a parsed XML file, each with its place in the file.
#pragma once

#include "renderer/io/xml_text.h"

#include <string_view>
#include <vector>

namespace plumb {

/// Views point into the XmlText (or, once a parameter was put in, into its owner's string pool).
struct XmlAttribute {
    std::string_view name, value;
    std::uint32_t offset = 0; ///< of the value in the text
};

struct XmlNode {
    const XmlText* file = nullptr;
    std::string_view name; ///< points into the text: its place is the element's
    std::vector<XmlAttribute> attributes;
    std::vector<XmlNode> children;

    /// Null if there is none.
    [[nodiscard]] const XmlAttribute* find(std::string_view attribute) const;
    /// The value; throws SceneError if there is no such attribute.
    [[nodiscard]] const XmlAttribute& require(std::string_view attribute) const;
    /// The value, or an empty view.
    [[nodiscard]] std::string_view value_or_empty(std::string_view attribute) const;
    /// Throws SceneError, with the nearest name, if an attribute is not in the list.
    void allow_only(std::initializer_list<std::string_view> attributes) const;

    [[nodiscard]] SourceLocation location() const;
    [[nodiscard]] SourceLocation location(const XmlAttribute& attribute) const;
    /// Throws SceneError at the element, or at an attribute's value.
    [[noreturn]] void refuse(const std::string& what) const;
    [[noreturn]] void refuse(const XmlAttribute& attribute, const std::string& what) const;
};

/// Checks (lint_xml) and parses the text in place. The nodes point into `xml`, which must not move.
/// Throws SceneError.
[[nodiscard]] XmlNode parse_xml(XmlText& xml);

} // namespace plumb
