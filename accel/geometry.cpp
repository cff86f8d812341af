#include "accel/geometry.h"

namespace plumb {
namespace {

struct EdgeCross {
    double x, y, z, length;
};

/// Cross product of two edges in double: twice the area, along the front normal.
EdgeCross edge_cross(const TriangleVertices& t) {
    const auto diff = [](float p, float q) {
        return static_cast<double>(p) - static_cast<double>(q);
    };
    const double ux = diff(t.b.x, t.a.x), uy = diff(t.b.y, t.a.y), uz = diff(t.b.z, t.a.z);
    const double vx = diff(t.c.x, t.a.x), vy = diff(t.c.y, t.a.y), vz = diff(t.c.z, t.a.z);
    const double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    return {x, y, z, std::hypot(x, y, z)};
}

} // namespace

std::size_t GeometryView::primitive_count() const {
    std::size_t count = spheres.size();
    for (const MeshView& mesh : meshes)
        count += mesh.triangles.size();
    return count;
}

bool is_traceable(const GeometryView& view, std::uint32_t geometry, std::uint32_t primitive) {
    if (view.is_sphere(geometry)) {
        const Sphere& s = view.spheres[primitive];
        return is_finite(s.center) && s.radius > 0 && s.radius <= max_coordinate;
    }
    const TriangleVertices t = view.vertices(geometry, primitive);
    return is_finite(t.a) && is_finite(t.b) && is_finite(t.c) && t.a != t.b && t.b != t.c &&
           t.c != t.a;
}

double primitive_area(const GeometryView& view, std::uint32_t geometry, std::uint32_t primitive) {
    if (view.is_sphere(geometry)) {
        const double r = static_cast<double>(view.spheres[primitive].radius);
        return 4 * 3.14159265358979323846 * r * r;
    }
    return 0.5 * edge_cross(view.vertices(geometry, primitive)).length;
}

SurfacePoint sample_primitive(const GeometryView& view, std::uint32_t geometry,
                              std::uint32_t primitive, Vec2 u) {
    if (view.is_sphere(geometry)) {
        const Sphere& s = view.spheres[primitive];
        const float z = 1 - 2 * u.x;
        const float r = std::sqrt(max(0.0f, 1 - z * z));
        const float phi = 2 * pi * u.y;
        const Vec3 n{r * std::cos(phi), r * std::sin(phi), z};
        return {s.center + s.radius * n, n};
    }
    const TriangleVertices t = view.vertices(geometry, primitive);
    const float root = std::sqrt(u.x);
    const float b = root * (1 - u.y), c = root * u.y;
    const EdgeCross cross = edge_cross(t);
    return {(1 - b - c) * t.a + b * t.b + c * t.c,
            {static_cast<float>(cross.x / cross.length), static_cast<float>(cross.y / cross.length),
             static_cast<float>(cross.z / cross.length)}};
}

double primitive_pdf_area(const GeometryView& view, std::uint32_t geometry,
                          std::uint32_t primitive) {
    const double area = primitive_area(view, geometry, primitive);
    return area > 0 ? 1 / area : 0;
}

} // namespace plumb
