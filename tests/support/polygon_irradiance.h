/// \file  Irradiance from a polygon of constant radiance, in closed form.
///
/// J. H. Lambert, Photometria, 1760; as written in D. Baum, H. Rushmeier, J. Winget, "Improving
/// Radiosity Solutions Through the Use of Analytically Determined Form-Factors", SIGGRAPH 1989.
#pragma once

#include "tests/support/scene_text.h"

#include <span>
#include <vector>

namespace plumb::test {

/// The part of a planar convex polygon with z >= 0 (Sutherland and Hodgman 1974).
[[nodiscard]] std::vector<Double3> clipped_to_horizon(std::span<const Double3> polygon);

/// Irradiance at the origin with normal +z from a planar convex polygon of radiance 1, whichever
/// way its corners turn; it is clipped to the horizon.
[[nodiscard]] double polygon_irradiance(std::span<const Double3> polygon);

/// Unit squares at distance 1 scaled by X = a/d, Y = b/d: form factor of parallel rectangles.
[[nodiscard]] double parallel_form_factor(double x, double y);

} // namespace plumb::test
