/// \file  Scene-wide geometry: indexed triangle meshes and spheres, host and device.
///
/// Ids: geometry g < meshes.size() is a mesh and its primitives are triangles; the one geometry
/// g == meshes.size() is the set of all spheres and its primitives are spheres.
#pragma once

#include "accel/sphere.h"
#include "accel/triangle.h"

#include <cstddef>
#include <span>

namespace plumb {

/// Vertex indices of one triangle, counter-clockwise seen from its front.
struct Triangle {
    std::uint32_t a = 0, b = 0, c = 0;
};

/// An indexed triangle mesh in world space. Every index must be < positions.size().
struct MeshView {
    std::span<const Vec3> positions;
    std::span<const Triangle> triangles;
};

struct TriangleVertices {
    Vec3 a, b, c;
};

struct GeometryView {
    std::span<const MeshView> meshes;
    std::span<const Sphere> spheres;

    [[nodiscard]] RT_HD std::uint32_t sphere_geometry() const {
        return static_cast<std::uint32_t>(meshes.size());
    }
    [[nodiscard]] RT_HD bool is_sphere(std::uint32_t geometry) const {
        return geometry == sphere_geometry();
    }
    [[nodiscard]] RT_HD TriangleVertices vertices(std::uint32_t geometry,
                                                  std::uint32_t primitive) const {
        const MeshView& mesh = meshes[geometry];
        const Triangle t = mesh.triangles[primitive];
        return {mesh.positions[t.a], mesh.positions[t.b], mesh.positions[t.c]};
    }
    /// Triangles and spheres together.
    [[nodiscard]] std::size_t primitive_count() const;
};

/// A point of a surface with its unit geometric normal.
struct SurfacePoint {
    Vec3 position, normal;
};

/// Whether a primitive takes part in intersection: coordinates finite and at most 1.8e18, radius
/// > 0, no two vertices equal (such a triangle is never hit: its edge functions cancel). Other
/// degenerate triangles take part (see intersect_triangle).
[[nodiscard]] bool is_traceable(const GeometryView&, std::uint32_t geometry,
                                std::uint32_t primitive);

[[nodiscard]] RT_HD inline Bounds primitive_bounds(const GeometryView& view, std::uint32_t geometry,
                                                   std::uint32_t primitive) {
    if (view.is_sphere(geometry))
        return sphere_bounds(view.spheres[primitive]);
    const TriangleVertices t = view.vertices(geometry, primitive);
    return triangle_bounds(t.a, t.b, t.c);
}

/// Surface area in world units squared.
[[nodiscard]] double primitive_area(const GeometryView&, std::uint32_t geometry,
                                    std::uint32_t primitive);

/// Point distributed uniformly over the surface for u uniform in [0,1)^2; outward normal on
/// spheres, counter-clockwise front on triangles. pdf: primitive_pdf_area.
[[nodiscard]] SurfacePoint sample_primitive(const GeometryView&, std::uint32_t geometry,
                                            std::uint32_t primitive, Vec2 u);

/// Pdf of sample_primitive with respect to area: 1 / area; 0 for a degenerate primitive.
[[nodiscard]] double primitive_pdf_area(const GeometryView&, std::uint32_t geometry,
                                        std::uint32_t primitive);

} // namespace plumb
