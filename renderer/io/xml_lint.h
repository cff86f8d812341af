/// \file  What pugixml accepts in silence: a check of the text before it is parsed.
#pragma once

#include "renderer/io/xml_text.h"

namespace plumb {

inline constexpr std::size_t max_xml_depth = 64;           ///< elements inside each other
inline constexpr std::size_t max_xml_elements = 1'000'000; ///< of one file
inline constexpr std::size_t max_xml_attributes = 64;      ///< of one element
inline constexpr std::size_t max_xml_value = 1024 * 1024;  ///< bytes of one attribute

/// One pass over the text, without recursion and with memory for the open elements only. Throws
/// SceneError(scene) at the place: truncated or mismatched tags, no or several roots, an attribute
/// given twice, any DOCTYPE or CDATA, entities other than the five of XML and character references,
/// text between elements, and what exceeds the limits above.
void lint_xml(const XmlText& xml);

} // namespace plumb
