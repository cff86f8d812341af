#include "tests/fuzz/ray_case.h"

#include "tests/fuzz/byte_reader.h"

#include <cmath>

namespace plumb::fuzz {
namespace {

enum class Coordinates { grid, far_grid, fine, raw };

/// Reads one case.
class CaseReader {
  public:
    CaseReader(const std::uint8_t* data, std::size_t size) : bytes_(data, size) {
        const auto flags = bytes_.take<std::uint8_t>();
        coordinates_ = static_cast<Coordinates>(flags & 3u);
        case_.with_embree = (flags & 4u) != 0;
        // Exponents of the whole scene, so that the same few shapes come in every size.
        scale_ = std::ldexp(1.0f, (flags & 8u) != 0 ? bytes_.take<std::int8_t>() / 3 : 0);
    }

    RayCase read() {
        const std::uint32_t vertices = bytes_.below(65), triangles = bytes_.below(97),
                            spheres = bytes_.below(5);
        test::Mesh mesh;
        for (std::uint32_t i = 0; i < vertices; ++i)
            mesh.positions.push_back(point());
        for (std::uint32_t i = 0; i < triangles && vertices > 0; ++i) {
            const std::uint32_t a = bytes_.below(vertices), b = bytes_.below(vertices);
            mesh.triangles.push_back({a, b, bytes_.below(vertices)});
        }
        const std::vector<Vec3> corners = mesh.positions;
        case_.geometry.add(std::move(mesh));
        for (std::uint32_t i = 0; i < spheres; ++i) {
            const Vec3 center = point();
            case_.geometry.add(Sphere{center, std::fabs(coordinate())});
        }
        while (!bytes_.at_end() && case_.rays.size() < 48)
            case_.rays.push_back(ray(corners));
        return std::move(case_);
    }

  private:
    float coordinate() {
        switch (coordinates_) {
        case Coordinates::grid: return scale_ * static_cast<float>(bytes_.take<std::int8_t>() / 16);
        case Coordinates::far_grid:
            return scale_ * (1e6f + static_cast<float>(bytes_.take<std::int8_t>()) / 8);
        case Coordinates::fine: return scale_ * 1e-3f * bytes_.take<std::int16_t>();
        default: return bytes_.take<float>();
        }
    }
    Vec3 point() {
        const float x = coordinate(), y = coordinate();
        return {x, y, coordinate()};
    }

    /// From a point along a direction, towards a corner, an edge or the middle of a triangle, or
    /// from a corner; sometimes of limited length.
    Ray ray(const std::vector<Vec3>& corners) {
        const auto kind = bytes_.take<std::uint8_t>();
        const auto corner = [&] {
            return corners.empty()
                       ? Vec3{}
                       : corners[bytes_.below(static_cast<std::uint32_t>(corners.size()))];
        };
        Ray ray;
        ray.origin = (kind & 16u) != 0 ? corner() : point();
        switch (kind & 3u) {
        case 0: ray.direction = point(); break;
        case 1: ray.direction = corner() - ray.origin; break;
        case 2: ray.direction = 0.5f * (corner() + corner()) - ray.origin; break;
        default: {
            const Vec3 a = corner(), b = corner(), c = corner();
            ray.direction = 0.5f * a + 0.25f * b + 0.25f * c - ray.origin;
        }
        }
        if ((kind & 4u) != 0)
            ray.tmin = raw_or_fraction(kind);
        if ((kind & 8u) != 0)
            ray.tmax = raw_or_fraction(kind);
        return ray;
    }
    float raw_or_fraction(std::uint8_t kind) {
        return (kind & 32u) != 0 ? bytes_.take<float>()
                                 : static_cast<float>(bytes_.take<std::uint8_t>()) / 64;
    }

    ByteReader bytes_;
    Coordinates coordinates_ = Coordinates::grid;
    float scale_ = 1;
    RayCase case_;
};

} // namespace

RayCase ray_case_of(const std::uint8_t* data, std::size_t size) {
    return CaseReader(data, size).read();
}

} // namespace plumb::fuzz
