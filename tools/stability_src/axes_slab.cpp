/// \file  Axes of the ray-box tests: boxes that a ray meets and must not be culled.
#include "tools/stability_src/alternatives/slab_tests.h"
#include "tools/stability_src/axis.h"
#include "tools/stability_src/random.h"
#include "tools/stability_src/wide_box.h"

#include <algorithm>
#include <array>

namespace plumb::stability {
namespace {

/// A ray and a box.
struct Case {
    Ray ray;
    Bounds box;
};

/// Whether the ray meets the closed box, in long double: its error is 2^-40 of a float's rounding.
bool meets(const Case& c) {
    long double near = 0, far = std::numeric_limits<long double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const long double o = c.ray.origin[axis], d = c.ray.direction[axis];
        const long double low = c.box.lower[axis] - o, high = c.box.upper[axis] - o;
        if (d == 0) {
            if (low > 0 || high < 0)
                return false;
            continue;
        }
        near = std::max(near, (d > 0 ? low : high) / d);
        far = std::min(far, (d > 0 ? high : low) / d);
    }
    return near <= far;
}

bool scalar(const Ray& ray, const Bounds& box) {
    return overlaps(slab_interval(SlabRay(ray), box), ray.tmin, ray.tmax);
}

struct Form {
    Method method;
    BoxTest test;
};

std::vector<Form> forms() {
    std::vector<Form> list{
        {{"min-max", "std::min and std::max of both planes"}, slab_min_max},
        {{"fmin-fmax", "the same with fmin and fmax"}, slab_fmin_fmax},
        {{"octant", "near and far plane by the sign bit, NaN ignored"},
         [](const Ray& ray, const Bounds& box) { return slab_octant(ray, box, 1); }},
        {{"octant-4u", "the same, far planes moved out by 4u"},
         [](const Ray& ray, const Bounds& box) {
             return slab_octant(ray, box, 1 + 4 * unit_roundoff);
         }},
        {{"fused", "fma(plane, 1/d, -origin/d) without a margin"}, slab_fused},
        {{"scalar", "this project's slab_interval, of naive and of every primitive", true, 0.0},
         scalar},
        {{"wide-portable", "this project's padded test of eight boxes, SSE2", true, 0.0},
         wide_box_portable}};
    if (const BoxTest fused = wide_box_fused())
        list.push_back({{"wide-fused", "the same with fused multiply-add, AVX", true, 0.0}, fused});
    return list;
}

using MakeCase = std::function<Case(Random&, double stress)>;

std::vector<Outcome> probe(const Trial& trial, const MakeCase& make) {
    const std::vector<Form> list = forms();
    std::vector<Outcome> outcomes(list.size());
    Random random(trial.seed);
    for (std::size_t i = 0; i < trial.count; ++i) {
        const Case c = make(random, trial.stress);
        if (!is_valid(c.ray) || !meets(c))
            continue;
        for (std::size_t k = 0; k < list.size(); ++k) {
            ++outcomes[k].trials;
            outcomes[k].failures += list[k].test(c.ray, c.box) ? 0u : 1u;
        }
    }
    return outcomes;
}

float random_sign(Random& random) { return random.index(2) == 0 ? 1.0f : -1.0f; }

Bounds random_box(Random& random) {
    const Vec3 lower = cube_point(random, -1, 1);
    return {lower, lower + cube_point(random, 0.1f, 1)};
}

Vec3 point_in(Random& random, const Bounds& box) { return random.point(box.lower, box.upper); }

/// Three axes in random order.
std::array<int, 3> shuffled(Random& random) {
    std::array<int, 3> order{0, 1, 2};
    std::swap(order[0], order[random.index(3)]);
    std::swap(order[1], order[1 + random.index(2)]);
    return order;
}

/// A ray towards the box with `zeros` components that are +0 or -0. `on_planes`: it runs along
/// planes of the box, and starts on them.
Case parallel_case(Random& random, double zeros, bool on_planes) {
    Case c;
    c.box = random_box(random);
    const Vec3 target = point_in(random, c.box);
    Vec3 origin = cube_point(random, -3, 3);
    Vec3 d = target - origin;
    const std::array<int, 3> order = shuffled(random);
    for (std::size_t i = 0; i < static_cast<std::size_t>(zeros); ++i) {
        const int axis = order[i];
        origin[axis] = target[axis];
        d[axis] = 0 * random_sign(random);
        if (on_planes)
            origin[axis] = random.index(2) == 0 ? c.box.lower[axis] : c.box.upper[axis];
    }
    c.ray = {origin, 0, d, infinity};
    return c;
}

/// A ray at an edge or a corner of the box.
Case edge_case(Random& random, const Bounds& box, Vec3 origin) {
    Vec3 target = point_in(random, box);
    const std::array<int, 3> order = shuffled(random);
    const std::size_t fixed = 2 + random.index(2);
    for (std::size_t i = 0; i < fixed; ++i)
        target[order[i]] = random.index(2) == 0 ? box.lower[order[i]] : box.upper[order[i]];
    return {{origin, 0, target - origin, infinity}, box};
}

Case thin_case(Random& random, double thinness) {
    Bounds box = random_box(random);
    const int axis = static_cast<int>(random.index(3));
    box.upper[axis] = box.lower[axis] + static_cast<float>(1 / thinness);
    return edge_case(random, box, cube_point(random, -3, 3));
}

/// At walls too: every other box is flat along one axis, and every other ray has a zero component.
Case offset_case(Random& random, double offset) {
    const auto o = static_cast<float>(offset);
    Bounds box = random_box(random);
    if (random.index(2) == 0) {
        const int axis = static_cast<int>(random.index(3));
        box.upper[axis] = box.lower[axis];
    }
    const Vec3 shift{o, -o, o};
    box = {box.lower + shift, box.upper + shift};
    Case c = edge_case(random, box, shift + cube_point(random, -3, 3));
    if (random.index(2) == 0) {
        const int axis = static_cast<int>(random.index(3));
        c.ray.origin[axis] = 0.5f * box.lower[axis] + 0.5f * box.upper[axis];
        c.ray.direction[axis] = 0 * random_sign(random);
    }
    return c;
}

Axis slab_axis(std::string name, std::string title, std::string unit, std::vector<double> stresses,
               const MakeCase& make) {
    Axis axis;
    axis.name = std::move(name);
    axis.group = "boxes";
    axis.title = std::move(title);
    axis.unit = std::move(unit);
    axis.failure = "the ray meets the box in long double and the test says no";
    axis.stresses = std::move(stresses);
    axis.trials = 1000000;
    axis.quick_trials = 10000;
    for (Form& form : forms())
        axis.methods.push_back(std::move(form.method));
    axis.run = [make](const Trial& trial) { return probe(trial, make); };
    return axis;
}

} // namespace

void add_slab_axes(std::vector<Axis>& axes) {
    axes.push_back(slab_axis(
        "slab-zero", "Zero direction components", "components that are +0 or -0", {0, 1, 2},
        [](Random& random, double zeros) { return parallel_case(random, zeros, false); }));
    axes.back().tested = "rays at random places in boxes, parallel to none, one or two axes";
    axes.back().range = "0 of all rays";
    axes.push_back(slab_axis(
        "slab-plane", "Origin on a slab plane", "planes of the box that the ray runs along",
        {0, 1, 2},
        [](Random& random, double planes) { return parallel_case(random, planes, true); }));
    axes.back().tested = "rays that start on as many planes of the box and run along them";
    axes.back().range = "0 of all rays";
    axes.push_back(
        slab_axis("slab-thin", "Thin boxes", "width / thickness", powers_of_ten(0, 8), thin_case));
    axes.back().tested = "rays at the edges and corners of boxes";
    axes.back().range = "0 of all rays from 1 to 1e8";
    axes.push_back(slab_axis("slab-offset", "Boxes far from the origin",
                             "units of the scene; boxes have size 0.1 to 1", zero_and_powers(0, 6),
                             offset_case));
    axes.back().tested = "rays at the edges and corners of boxes and walls, every other one with a "
                         "component that is zero";
    axes.back().range = "0 of all rays from 0 to 1e6";
}

} // namespace plumb::stability
