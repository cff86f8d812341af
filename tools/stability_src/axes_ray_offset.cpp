/// \file  Axes of the ways to start a ray off a surface: self-hits, and gaps that are stepped over.
#include "renderer/shading/interaction.h"
#include "tools/stability_src/alternatives/ray_offsets.h"
#include "tools/stability_src/axis.h"
#include "tools/stability_src/random.h"

#include <array>

namespace plumb::stability {
namespace {

using Leave = Ray (*)(const Interaction& it, Vec3 direction);

struct Way {
    const char *name, *what;
    Leave leave;
};

const std::array ways{
    Way{"none", "from the hit point as it is",
        [](const Interaction& it, Vec3 d) {
            return Ray{it.position, 0, d, infinity};
        }},
    Way{"tmin-1e-4", "tmin = 1e-4",
        [](const Interaction& it, Vec3 d) { return leave_with_tmin(it.position, d); }},
    Way{"normal-1e-3", "1e-3 along the normal",
        [](const Interaction& it, Vec3 d) {
            return leave_along_normal(it.position, it.geometric, d);
        }},
    Way{"integers", "a step in ulp: Wächter and Binder 2019",
        [](const Interaction& it, Vec3 d) {
            return leave_by_integers(it.position, it.geometric, d);
        }},
    Way{"own", "this project's: by the bound of the error", [](const Interaction& it, Vec3 d) {
            return Ray{offset_origin(it.position, it.error, it.geometric, d), 0, d, infinity};
        }}};

std::vector<Method> methods() {
    std::vector<Method> list;
    for (const Way& way : ways)
        list.push_back({way.name, way.what});
    list.back().is_default = true;
    list.back().limit = 0;
    return list;
}

/// A triangle that a ray has hit.
struct HitTriangle {
    TriangleVertices vertices;
    Interaction at;
};

std::optional<HitTriangle> hit(const TriangleVertices& t, const Ray& ray) {
    PrimitiveHit p;
    if (!is_valid(ray) || !intersect_triangle(PreparedRay(ray), t.a, t.b, t.c, ray.tmax, p))
        return {};
    return HitTriangle{t, detail::interact_triangle(t, p.u, p.v, ray.direction)};
}

bool hits(const Ray& ray, const TriangleVertices& t) {
    PrimitiveHit p;
    return intersect_triangle(PreparedRay(ray), t.a, t.b, t.c, ray.tmax, p);
}

/// Ratio of the longest edge to the height above it.
float aspect(const TriangleVertices& t) {
    const Vec3 e1 = t.b - t.a, e2 = t.c - t.a, e3 = t.c - t.b;
    return max(dot(e1, e1), max(dot(e2, e2), dot(e3, e3))) / length(cross(e1, e2));
}

/// On the side of n, every other one within 1e-7 .. 1 of the surface.
Vec3 leaving(Random& random, Vec3 n, bool grazing) {
    Vec3 d = direction(random);
    d = dot(d, n) < 0 ? -d : d;
    if (!grazing)
        return d;
    const float height = std::exp(-16 * random.uniform());
    return normalize(d - n * (dot(d, n) - height));
}

/// A place on the triangle: the inside, an edge or a corner.
Vec3 place(Random& random, const TriangleVertices& t) {
    Vec3 w{random.uniform(), random.uniform(), random.uniform()};
    const std::size_t kind = random.index(8);
    if (kind <= 1)
        w.x = 0;
    if (kind == 0)
        w.y = 0;
    w = w / max(1e-20f, w.x + w.y + w.z);
    return w.x * t.a + w.y * t.b + w.z * t.c;
}

using MakeTriangle = std::function<TriangleVertices(Random&)>;

/// Triangles of about `size` that are up to `max_aspect` times longer than wide.
std::vector<Outcome> self_hits(const Trial& trial, float size, float max_aspect,
                               const MakeTriangle& make) {
    std::vector<Outcome> outcomes(ways.size());
    Random random(trial.seed);
    for (std::size_t i = 0; i < trial.count; ++i) {
        const TriangleVertices t = make(random);
        const Vec3 at = place(random, t);
        const Vec3 back = direction(random);
        const Vec3 origin = at + back * (size * random.uniform(0.01f, 3));
        const bool front = random.index(2) == 0;
        const auto found = hit(t, {origin, 0, at - origin, infinity});
        if (!found || !(aspect(t) < max_aspect))
            continue;
        const Vec3 side = front ? found->at.geometric : -found->at.geometric;
        const Vec3 d = leaving(random, side, i % 2 == 0);
        if (!(dot(d, side) > 0))
            continue;
        for (std::size_t k = 0; k < ways.size(); ++k) {
            ++outcomes[k].trials;
            outcomes[k].failures += hits(ways[k].leave(found->at, d), t);
        }
    }
    return outcomes;
}

/// Corners within two sizes of (offset, -offset, offset), along each axis.
std::vector<Outcome> random_self_hits(const Trial& trial, float size, float offset) {
    // Up to this aspect no ray meets its triangle again, whatever the offset.
    return self_hits(trial, size, 1e4f, [&](Random& random) {
        const auto corner = [&] {
            return Vec3{offset, -offset, offset} + size * cube_point(random, -2, 2);
        };
        const Vec3 a = corner(), b = corner();
        return TriangleVertices{a, b, corner()};
    });
}

/// Slivers of length 1: any orientation or along an axis, the third corner anywhere along them.
std::vector<Outcome> sliver_self_hits(const Trial& trial) {
    return self_hits(trial, 1, infinity, [&](Random& random) {
        Vec3 along = direction(random), across = direction(random);
        if (random.index(3) == 0) {
            along = {};
            along[static_cast<int>(random.index(3))] = 1;
        }
        across = normalize(cross(along, across));
        const float height = static_cast<float>(1 / trial.stress);
        const float place = random.index(2) == 0 ? 0.0f : random.uniform();
        const Vec3 a = cube_point(random, -1, 1);
        return TriangleVertices{a, a + along, a + place * along + height * across};
    });
}

/// Two parallel walls as long as the scene, a gap of 1e-4 of that between them.
std::vector<Outcome> gaps(const Trial& trial, float scene, float offset) {
    std::vector<Outcome> outcomes(ways.size());
    Random random(trial.seed);
    const Vec3 o{offset, offset, offset}, up{0, 0, 1e-4f * scene};
    const TriangleVertices wall{o, o + Vec3{scene, 0, 0}, o + Vec3{0, scene, 0}};
    const TriangleVertices second{wall.a + up, wall.b + up, wall.c + up};
    for (std::size_t i = 0; i < trial.count; ++i) {
        const auto share = [&](float low, float width) {
            return scene * (low + width * random.uniform());
        };
        const float x = share(0, 0.3f), y = share(0, 0.3f);
        const Vec3 from = o + Vec3{x, y, -scene};
        const float u = share(0.05f, 0.3f), v = share(0.05f, 0.3f);
        const Vec3 to = o + Vec3{u, v, 0};
        const Vec3 d = normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), 1});
        const auto found = hit(wall, {from, 0, to - from, infinity});
        if (!found)
            continue;
        for (std::size_t k = 0; k < ways.size(); ++k) {
            ++outcomes[k].trials;
            outcomes[k].failures += !hits(ways[k].leave(found->at, d), second);
        }
    }
    return outcomes;
}

Axis offset_axis(std::string name, std::string title, std::string unit) {
    Axis axis;
    axis.name = std::move(name);
    axis.group = "leaving a surface";
    axis.title = std::move(title);
    axis.unit = std::move(unit);
    axis.trials = 1000000;
    axis.quick_trials = 20000;
    axis.methods = methods();
    return axis;
}

void describe_self_hits(Axis& axis) {
    axis.tested = "rays that leave a random triangle where another ray has hit it, half of them "
                  "grazing; triangles up to 1e4 times longer than wide";
    axis.failure = "the ray meets the triangle that it leaves";
}

void describe_gaps(Axis& axis) {
    axis.tested = "rays that leave a wall towards a second one, a gap of 1e-4 of the scene away";
    axis.failure = "the second wall is not met";
}

} // namespace

void add_ray_offset_axes(std::vector<Axis>& axes) {
    Axis self = offset_axis("self-hit", "Self-hits far from the origin",
                            "offset in units of the scene; triangles of size 1");
    describe_self_hits(self);
    self.range = "0 of all rays from 0 to 1e6";
    self.stresses = zero_and_powers(0, 6);
    self.run = [](const Trial& trial) {
        return random_self_hits(trial, 0.5f, static_cast<float>(trial.stress));
    };
    axes.push_back(std::move(self));

    Axis scale = offset_axis("self-hit-scale", "Self-hits of small and large triangles",
                             "size of the triangles, around the origin");
    describe_self_hits(scale);
    scale.range = "0 of all rays from 1e-6 to 1e6";
    scale.stresses = powers_of_ten(-6, 6);
    scale.run = [](const Trial& trial) {
        return random_self_hits(trial, static_cast<float>(0.5 * trial.stress), 0);
    };
    axes.push_back(std::move(scale));

    Axis sliver = offset_axis("self-hit-sliver", "Self-hits of slivers",
                              "length of the triangle / width, within 1 of the origin");
    describe_self_hits(sliver);
    sliver.tested = "rays that leave a sliver of length 1 where another ray has hit it, half of "
                    "them grazing";
    sliver.range = "0 of all rays from 1 to 1e4";
    sliver.stresses = powers_of_ten(0, 7);
    sliver.methods.back().from = 1;
    sliver.methods.back().to = 1e4;
    sliver.run = sliver_self_hits;
    axes.push_back(std::move(sliver));

    Axis gap = offset_axis("gap", "Thin gaps far from the origin",
                           "offset in units of the scene; scene of size max(10, 2 offset)");
    describe_gaps(gap);
    gap.range = "0 of all rays from 0 to 1e6";
    gap.stresses = zero_and_powers(0, 6);
    gap.trials = 200000;
    gap.run = [](const Trial& trial) {
        const auto offset = static_cast<float>(trial.stress);
        return gaps(trial, max(10.0f, 2 * offset), offset);
    };
    axes.push_back(std::move(gap));

    Axis small = offset_axis("gap-scale", "Thin gaps of small and large scenes",
                             "size of the scene, around the origin");
    describe_gaps(small);
    small.range = "0 of all rays from 1e-6 to 1e6";
    small.stresses = powers_of_ten(-6, 6);
    small.trials = 200000;
    small.run = [](const Trial& trial) { return gaps(trial, static_cast<float>(trial.stress), 0); };
    axes.push_back(std::move(small));
}

} // namespace plumb::stability
