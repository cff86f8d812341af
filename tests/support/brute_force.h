/// \file  The oracle: every primitive tested against a ray in extended precision, no epsilon.
#pragma once

#include "accel/geometry.h"

#include <optional>

namespace plumb::test {

/// A hit in extended precision. `edge` is how far inside the triangle the hit lies: the smallest of
/// the three barycentrics (0 on an edge); for spheres the share of the radius by which the ray
/// passes inside the silhouette.
struct ExactHit {
    double t = 0, u = 0, v = 0;
    double edge = 0;
    std::uint32_t geometry = invalid_id, primitive = invalid_id;
};

/// Hit of one primitive with tmin < t <= tmax; of a sphere's two the nearer one. Triangles count
/// with barycentrics >= -slack, spheres where the ray passes within radius * (1 + slack): a slack
/// above 0 tells a hit that rounding explains from one that is wrong. Degenerate triangles and
/// primitives that are not traceable give nothing.
[[nodiscard]] std::optional<ExactHit> exact_hit(const GeometryView& view, std::uint32_t geometry,
                                                std::uint32_t primitive, const Ray& ray,
                                                double slack = 0);

/// Nearest hit over all primitives; of equal t the lowest (geometry, primitive). Invalid rays give
/// nothing.
[[nodiscard]] std::optional<ExactHit> brute_force_closest(const GeometryView& view, const Ray& ray);

/// Whether any primitive is hit.
[[nodiscard]] bool brute_force_occluded(const GeometryView& view, const Ray& ray);

} // namespace plumb::test
