/// \file  Axes of the sphere tests: far small spheres, and large ones as walls.
#include "renderer/shading/interaction.h"
#include "tools/stability_src/alternatives/sphere_tests.h"
#include "tools/stability_src/axis.h"
#include "tools/stability_src/random.h"

#include <algorithm>
#include <array>

namespace plumb::stability {
namespace {

using Real = long double;

std::optional<float> own_test(const Ray& ray, const Sphere& sphere) {
    PrimitiveHit hit;
    if (!intersect_sphere(PreparedRay(ray), sphere, ray.tmax, hit))
        return {};
    return hit.t;
}

struct Test {
    const char *name, *what;
    std::optional<float> (*hit)(const Ray&, const Sphere&);
};

const std::array tests{
    Test{"quadratic-float", "b^2 - 4ac in float", sphere_quadratic},
    Test{"hearn-baker-float", "Hearn and Baker's discriminant in float", sphere_hearn_baker},
    Test{"own", "this project's: Hearn and Baker's in double", own_test}};

std::vector<Method> methods(double limit) {
    std::vector<Method> list;
    for (const Test& test : tests)
        list.push_back({test.name, test.what});
    list.back().is_default = true;
    list.back().limit = limit;
    return list;
}

/// Exact geometry of a ray and a sphere.
struct Exact {
    Real miss; ///< distance of the ray's line from the centre, in radii
    Real near; ///< t of the first crossing; NaN without one
};

Exact exact(const Ray& ray, const Sphere& s) {
    Real f[3], d[3], a = 0, b = 0;
    for (int k = 0; k < 3; ++k) {
        f[k] = static_cast<Real>(ray.origin[k]) - static_cast<Real>(s.center[k]);
        d[k] = ray.direction[k];
        a += d[k] * d[k];
        b -= f[k] * d[k];
    }
    Real l2 = 0;
    for (int k = 0; k < 3; ++k) {
        const Real l = f[k] + b / a * d[k];
        l2 += l * l;
    }
    const Real r = s.radius;
    return {std::sqrt(l2) / r, (b - std::sqrt(a * (r * r - l2))) / a};
}

/// Ray from `distance` away that passes the centre at `miss` radii, within rounding.
Ray ray_past(Random& random, const Sphere& s, double distance, double miss) {
    const Vec3 back = direction(random);
    const Vec3 side = normalize(cross(back, direction(random)));
    const Vec3 origin = s.center + static_cast<float>(distance) * back;
    Vec3 d;
    for (int k = 0; k < 3; ++k)
        d[k] =
            static_cast<float>(static_cast<double>(s.center[k]) - static_cast<double>(origin[k]) +
                               miss * static_cast<double>(s.radius) * static_cast<double>(side[k]));
    return {origin, 0, random.index(2) == 0 ? d : normalize(d), infinity};
}

const Sphere small_sphere{{0.3f, -0.2f, 0.7f}, 0.25f};

Ray ray_near(Random& random, double ratio) {
    return ray_past(random, small_sphere, ratio * static_cast<double>(small_sphere.radius),
                    2 * uniform_double(random));
}

/// Wrong where the line passes the silhouette by more than double's own rounding of its distance.
std::vector<Outcome> decisions(const Trial& trial) {
    std::vector<Outcome> outcomes(tests.size());
    Random random(trial.seed);
    const Real band = 1e-11L + 1e-15L * static_cast<Real>(trial.stress);
    for (std::size_t i = 0; i < trial.count; ++i) {
        const Ray ray = ray_near(random, trial.stress);
        const Exact truth = exact(ray, small_sphere);
        if (!(std::fabs(truth.miss - 1) > band))
            continue;
        for (std::size_t k = 0; k < tests.size(); ++k) {
            ++outcomes[k].trials;
            outcomes[k].failures += tests[k].hit(ray, small_sphere).has_value() != (truth.miss < 1);
        }
    }
    return outcomes;
}

Real off_surface(const Sphere& s, const Real (&p)[3]) {
    Real sum = 0;
    for (int k = 0; k < 3; ++k) {
        const Real d = p[k] - static_cast<Real>(s.center[k]);
        sum += d * d;
    }
    return std::fabs(std::sqrt(sum) / static_cast<Real>(s.radius) - 1);
}

/// Where a renderer would take the hit to be: origin + t direction in float.
Vec3 along(const Ray& ray, float t) { return ray.origin + t * ray.direction; }

Vec3 reprojected(const Ray& ray, float t) {
    const std::array<Surface, 1> surfaces{};
    SceneView scene;
    scene.geometry = {{}, {&small_sphere, 1}};
    scene.surfaces = surfaces;
    return interact<true, false>(scene, {t, 0, 0, 0, 0, invalid_id}, ray).position;
}

std::vector<Outcome> positions(const Trial& trial) {
    std::vector<Outcome> outcomes(tests.size());
    Random random(trial.seed);
    for (Outcome& o : outcomes)
        o.value = 0;
    for (std::size_t i = 0; i < trial.count; ++i) {
        const Ray ray = ray_near(random, trial.stress);
        if (!(exact(ray, small_sphere).miss < 1))
            continue;
        for (std::size_t k = 0; k < tests.size(); ++k) {
            const auto t = tests[k].hit(ray, small_sphere);
            if (!t)
                continue;
            ++outcomes[k].trials;
            const Vec3 p = k + 1 == tests.size() ? reprojected(ray, *t) : along(ray, *t);
            const Real at[3] = {p.x, p.y, p.z};
            outcomes[k].value =
                std::max(*outcomes[k].value, static_cast<double>(off_surface(small_sphere, at)));
        }
    }
    return outcomes;
}

/// The wall is the top of a sphere whose centre lies below.
std::vector<Outcome> walls(const Trial& trial) {
    const auto radius = static_cast<float>(trial.stress);
    const Sphere wall{{0, 0, -radius}, radius};
    std::vector<Outcome> outcomes(tests.size());
    Random random(trial.seed);
    for (Outcome& o : outcomes)
        o.value = 0;
    const float reach = min(5.0f, 0.5f * radius);
    for (std::size_t i = 0; i < trial.count; ++i) {
        const Vec3 origin{random.uniform(-reach, reach), random.uniform(-reach, reach),
                          random.uniform(0.1f, 10)};
        const Vec3 target{random.uniform(-reach, reach), random.uniform(-reach, reach), -0.5f};
        const Ray ray{origin, 0, target - origin, infinity};
        const Exact truth = exact(ray, wall);
        if (!(truth.miss < 0.99L)) // else the root itself is ill-conditioned
            continue;
        for (std::size_t k = 0; k < tests.size(); ++k) {
            const auto t = tests[k].hit(ray, wall);
            ++outcomes[k].trials;
            const Real error = t ? std::fabs(static_cast<Real>(*t) - truth.near) / truth.near : 1;
            outcomes[k].value = std::max(*outcomes[k].value, static_cast<double>(error));
        }
    }
    return outcomes;
}

Axis sphere_axis(std::string name, std::string title, std::string unit) {
    Axis axis;
    axis.name = std::move(name);
    axis.group = "spheres";
    axis.title = std::move(title);
    axis.unit = std::move(unit);
    axis.trials = 300000;
    axis.quick_trials = 5000;
    return axis;
}

} // namespace

void add_sphere_axes(std::vector<Axis>& axes) {
    std::vector<double> ratios = powers_of_ten(0, 6);
    ratios.front() = 1.001;

    Axis decision = sphere_axis("sphere", "Far spheres: hit or miss", "distance / radius");
    decision.tested = "rays that pass the centre at up to 2 radii";
    decision.failure = "a hit where there is none or a miss where there is a hit, the silhouette's "
                       "last 1e-11 + 1e-15 distance/radius left out (the rounding of double)";
    decision.range = "0 of all rays from 1 to 1e6";
    decision.stresses = ratios;
    decision.methods = methods(0);
    decision.run = decisions;
    axes.push_back(std::move(decision));

    Axis position = sphere_axis("sphere-point", "Far spheres: the hit point", "distance / radius");
    position.tested = "the same rays, where both sides find a hit";
    position.failure = "value: distance of the hit point from the sphere, the worst of all rays, "
                       "in radii";
    position.range = "at most 3e-7 radii from 1 to 1e6";
    position.value = "worst distance from the sphere";
    position.stresses = ratios;
    position.methods = methods(3e-7);
    position.methods.back().what += ", the point moved onto the sphere";
    position.run = positions;
    axes.push_back(std::move(position));

    Axis wall = sphere_axis("sphere-wall", "Spheres as walls", "radius");
    wall.tested = "rays from 0.1 to 10 above the top of a sphere";
    wall.failure = "value: relative error of t, the worst of all rays";
    wall.range = "at most 4 ulp (4.8e-7) from 10 to 1e6";
    wall.value = "worst relative error of t";
    wall.stresses = powers_of_ten(1, 6);
    wall.methods = methods(4 * 0x1p-23);
    wall.run = walls;
    axes.push_back(std::move(wall));
}

} // namespace plumb::stability
