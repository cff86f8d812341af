/// \file  <transform> elements.
#pragma once

#include "accel/math/transform.h"
#include "renderer/io/xml_node.h"

namespace plumb {

/// The product of the element's operations, of which each acts after those before it: translate,
/// rotate, scale, matrix (16 numbers row by row, or 9), lookat. Invertible and affine, else
/// SceneError at the operation.
[[nodiscard]] Transform parse_transform(const XmlNode& element);

/// `x`, `y`, `z` (each optional) or a `value` of three numbers, or of one for all three.
[[nodiscard]] std::array<double, 3> parse_triple(const XmlNode& element, double fallback);

} // namespace plumb
