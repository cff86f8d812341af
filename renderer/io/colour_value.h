/// \file  Colours as scene files write them.
#pragma once

#include "renderer/io/srgb.h"
#include "renderer/io/xml_node.h"
#include "renderer/scene/rgb.h"

#include <optional>

namespace plumb {

/// Numbers separated by white space and commas. Throws SceneError at the attribute for anything
/// else. `what` names the value in messages.
[[nodiscard]] std::vector<float> parse_floats(const XmlNode& node, const XmlAttribute& attribute);
[[nodiscard]] std::vector<double> parse_doubles(const XmlNode& node, const XmlAttribute& attribute);

/// Whether the element is one that parse_colour reads: rgb, srgb, color, spectrum, float.
[[nodiscard]] bool is_colour_element(std::string_view element);

/// The scene-linear Rec. 709 colour of an element with a `value`:
/// <rgb> three numbers or one (linear), or `#rrggbb` (sRGB-encoded); <srgb> the same, all
/// sRGB-encoded; <color> as <rgb>; <spectrum> and <float> one number, the same for all channels.
/// Nothing for a spectrum given as wavelength:value pairs. Throws SceneError.
[[nodiscard]] std::optional<Rgb> parse_colour(const XmlNode& element);

/// The mean of the values of a spectrum of wavelength:value pairs. Throws SceneError.
[[nodiscard]] float mean_of_spectrum(const XmlNode& element);

} // namespace plumb
