/// \file  The one file that sees pugixml.
#include "renderer/io/xml_node.h"

#include "renderer/io/nearest_name.h"
#include "renderer/io/xml_lint.h"

#include <algorithm>
#include <fmt/format.h>
#include <pugixml.hpp>

namespace plumb {
namespace {

/// Recursive: lint_xml has limited the depth. Frees pugixml's nodes on the way, so that no two
/// whole trees stand in memory.
XmlNode convert(pugi::xml_node from, const XmlText& xml) {
    XmlNode node;
    node.file = &xml;
    node.name = from.name();
    const auto attributes = from.attributes();
    node.attributes.reserve(
        static_cast<std::size_t>(std::distance(attributes.begin(), attributes.end())));
    for (const pugi::xml_attribute& attribute : attributes) {
        // In-place parsing leaves every value where it stood, so the pointer tells the place.
        const std::string_view value = attribute.value();
        const auto offset =
            value.empty() ? attribute.name() - xml.text.data() : value.data() - xml.text.data();
        node.attributes.push_back({attribute.name(), value, static_cast<std::uint32_t>(offset)});
    }
    const auto children = from.children();
    node.children.reserve(
        static_cast<std::size_t>(std::distance(children.begin(), children.end())));
    while (const pugi::xml_node child = from.first_child()) {
        node.children.push_back(convert(child, xml));
        from.remove_child(child);
    }
    return node;
}

} // namespace

const XmlAttribute* XmlNode::find(std::string_view attribute) const {
    const auto found = std::find_if(attributes.begin(), attributes.end(),
                                    [&](const XmlAttribute& a) { return a.name == attribute; });
    return found == attributes.end() ? nullptr : &*found;
}

const XmlAttribute& XmlNode::require(std::string_view attribute) const {
    if (const XmlAttribute* found = find(attribute))
        return *found;
    refuse(fmt::format("missing attribute '{}' of <{}>", attribute, name));
}

std::string_view XmlNode::value_or_empty(std::string_view attribute) const {
    const XmlAttribute* found = find(attribute);
    return found ? found->value : std::string_view{};
}

void XmlNode::allow_only(std::initializer_list<std::string_view> allowed) const {
    for (const XmlAttribute& attribute : attributes)
        if (std::find(allowed.begin(), allowed.end(), attribute.name) == allowed.end())
            refuse(attribute, fmt::format("unknown attribute '{}' of <{}>{}", attribute.name, name,
                                          did_you_mean(attribute.name, allowed)));
}

SourceLocation XmlNode::location() const {
    // The '<' stands before the name.
    return file->at(static_cast<std::size_t>(name.data() - file->text.data()) - 1);
}

SourceLocation XmlNode::location(const XmlAttribute& attribute) const {
    return file->at(attribute.offset);
}

void XmlNode::refuse(const std::string& what) const {
    throw SceneError(ErrorKind::scene, location(), one_line(what), file->included_from);
}

void XmlNode::refuse(const XmlAttribute& attribute, const std::string& what) const {
    throw SceneError(ErrorKind::scene, location(attribute), one_line(what), file->included_from);
}

XmlNode parse_xml(XmlText& xml) {
    lint_xml(xml);
    pugi::xml_document document;
    const unsigned flags = pugi::parse_minimal | pugi::parse_escapes | pugi::parse_wconv_attribute;
    const pugi::xml_parse_result result =
        document.load_buffer_inplace(xml.text.data(), xml.text.size(), flags, pugi::encoding_utf8);
    if (!result)
        xml.refuse(static_cast<std::size_t>(result.offset),
                   fmt::format("bad XML: {}", result.description()));
    return convert(document.document_element(), xml);
}

} // namespace plumb
