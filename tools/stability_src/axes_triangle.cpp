/// \file  Axes of the triangle tests and the trees: rays that meet a mesh and must not pass
/// through.
#include "tools/stability_src/edge_rays.h"

#include <algorithm>

namespace plumb::stability {
namespace {

using MakeMesh = std::function<Mesh(double stress)>;
using MakeRay = std::function<AimedRay(Random&, const Mesh&, double stress)>;

std::vector<Outcome> probe(const Trial& trial, const MakeMesh& make_mesh, const MakeRay& make_ray) {
    const Mesh mesh = make_mesh(trial.stress);
    std::vector<std::unique_ptr<Prober>> probers;
    for (const ProbedMethod& m : probed_methods())
        probers.push_back(m.prepare(mesh));
    std::vector<Outcome> outcomes(probers.size());
    Random random(trial.seed);
    std::vector<AimedRay> rays;
    constexpr std::size_t batch = 4096;
    for (std::size_t done = 0; done < trial.count; done += rays.size()) {
        rays.clear();
        while (rays.size() < std::min(batch, trial.count - done))
            rays.push_back(make_ray(random, mesh, trial.stress));
        for (std::size_t i = 0; i < probers.size(); ++i) {
            outcomes[i].trials += rays.size();
            outcomes[i].failures += probers[i]->misses(rays);
        }
    }
    return outcomes;
}

std::vector<Method> methods() {
    std::vector<Method> list;
    for (ProbedMethod& m : probed_methods())
        list.push_back(std::move(m.method));
    return list;
}

Axis triangle_axis(std::string name, std::string title, std::string unit,
                   std::vector<double> stresses, const MakeMesh& mesh, const MakeRay& ray) {
    Axis axis;
    axis.name = std::move(name);
    axis.group = "triangles";
    axis.title = std::move(title);
    axis.unit = std::move(unit);
    axis.failure = "the ray hits no triangle of the mesh";
    axis.stresses = std::move(stresses);
    axis.trials = 200000;
    axis.quick_trials = 4000;
    axis.methods = methods();
    axis.run = [mesh, ray](const Trial& trial) { return probe(trial, mesh, ray); };
    return axis;
}

constexpr std::uint32_t rings = 24;

Mesh sphere_at(double radius, double offset) {
    return closed_sphere(rings, [&](Point p) {
        return Point{offset + radius * p.x, offset + radius * p.y, offset + radius * p.z};
    });
}

/// Within 30 % of the radius from the centre, along each axis.
Vec3 inside(Random& random, double radius, double offset) {
    const auto o = static_cast<float>(offset), r = static_cast<float>(0.3 * radius);
    return Vec3{o, o, o} + r * cube_point(random, -1, 1);
}

constexpr double size = 50;

/// A sphere whose thickness is 1/aspect of its length, turned so that no axis is special.
Point thin(Point p, double aspect) {
    const double x = p.x / aspect, y = p.y / aspect, z = p.z;
    // Columns of a rotation with rational entries (1/9 of integers).
    return {(8 * x - 4 * y + z) / 9, (x + 4 * y + 8 * z) / 9, (-4 * x - 7 * y + 4 * z) / 9};
}

Vec3 inside_thin(Random& random, double aspect) {
    const auto unit = [&] { return 0.6 * uniform_double(random) - 0.3; };
    const double x = unit(), y = unit();
    const Point p = thin({x, y, unit()}, aspect);
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// From `distance` away at the middle of a square of 10, at 17 degrees or more from its plane.
AimedRay ray_from_afar(Random& random, const Mesh&, double distance) {
    constexpr std::uint32_t cells = 12;
    Vec3 back = direction(random);
    back.z = 0.3f + std::fabs(back.z);
    const Vec3 target{random.uniform(-4, 4), random.uniform(-4, 4), 0};
    const Vec3 origin = target + static_cast<float>(distance) * normalize(back);
    const auto cell = [](float x) { return static_cast<std::uint32_t>((x + 5) * 1.2f); };
    const std::uint32_t a = cell(target.y) * (cells + 1) + cell(target.x);
    return {{origin, 0, target - origin, infinity}, a, a + cells + 2};
}

} // namespace

void add_triangle_axes(std::vector<Axis>& axes) {
    axes.push_back(triangle_axis(
        "offset", "Mesh far from the origin", "units of the scene; the mesh has radius 50",
        zero_and_powers(0, 6), [](double offset) { return sphere_at(size, offset); },
        [](Random& random, const Mesh& mesh, double offset) {
            return ray_to_edge(random, mesh, inside(random, size, offset));
        }));
    axes.back().tested = "rays from inside a closed sphere of 2208 triangles, moved by the offset "
                         "along all three axes, at places on its edges";
    axes.back().range = "0 of all rays from 0 to 1e6";

    axes.push_back(triangle_axis(
        "vertices", "Rays at vertices", "offset of the mesh in units of the scene",
        zero_and_powers(0, 6), [](double offset) { return sphere_at(size, offset); },
        [](Random& random, const Mesh& mesh, double offset) {
            return ray_to_vertex(random, mesh, inside(random, size, offset));
        }));
    axes.back().tested = "rays from inside the same sphere at its vertices, exactly";
    axes.back().range = "0 of all rays from 0 to 1e6 (Embree's robust mode: up to 0.5 %)";

    axes.push_back(triangle_axis(
        "scale", "Small and large meshes", "radius of the mesh", powers_of_ten(-6, 6),
        [](double scale) { return sphere_at(scale, 0); },
        [](Random& random, const Mesh& mesh, double scale) {
            return ray_to_edge(random, mesh, inside(random, scale, 0));
        }));
    axes.back().tested = "rays from inside a closed sphere around the origin at its edges";
    axes.back().range = "0 of all rays from 1e-6 to 1e6";

    axes.push_back(triangle_axis(
        "needle", "Needles", "length of the triangles / width", powers_of_ten(0, 6),
        [](double aspect) {
            return closed_sphere(rings, [&](Point p) { return thin(p, aspect); });
        },
        [](Random& random, const Mesh& mesh, double aspect) {
            return ray_to_edge(random, mesh, inside_thin(random, aspect));
        }));
    axes.back().tested = "rays from inside a closed ellipsoid that is as many times longer than "
                         "thick, at its edges";
    axes.back().range = "0 of all rays from 1 to 1e6";

    axes.push_back(triangle_axis(
        "distance", "Rays from far away", "distance of the origin; the mesh is 10 wide",
        powers_of_ten(0, 6), [](double) { return plane(10, 12); }, ray_from_afar));
    axes.back().tested = "rays at random places in the middle of a square of 12 x 12 cells";
    axes.back().range = "0 of all rays from 1 to 1e6";
}

} // namespace plumb::stability
