/// \file  Any geometry and rays through every Intersector.
///
/// A loop over all primitives with the same test, naive, and sah in every quality and instruction
/// set must give the same bits, one by one and as streams. What they say must be right by the
/// referee's bounds wherever brute force in extended precision finds a hit or finds none. Embree
/// may differ from naive in what its README names, which is what the classifier explains.

#include "accel/validate/classify.h"
#include "accel/validate/referee.h"
#include "tests/fuzz/finding.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/ray_case.h"
#include "tests/support/brute_force.h"
#include "tests/support/hits.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace plumb::fuzz {
namespace {

using test::same_bits;

std::string text_of(const Ray& r) {
    const auto hex = [](Vec3 v) {
        char text[96];
        std::snprintf(text, sizeof text, "(%a %a %a)", static_cast<double>(v.x),
                      static_cast<double>(v.y), static_cast<double>(v.z));
        return std::string(text);
    };
    char range[64];
    std::snprintf(range, sizeof range, " %a..%a", static_cast<double>(r.tmin),
                  static_cast<double>(r.tmax));
    return "ray " + hex(r.origin) + " along " + hex(r.direction) + range;
}
std::string text_of(const Hit& hit) {
    return hit.valid() ? "geometry " + std::to_string(hit.geometry) + " primitive " +
                             std::to_string(hit.primitive) + " t " + std::to_string(hit.t)
                       : "no hit";
}

/// The nearest hit by a loop over all primitives with the float tests: no tree.
template <TriangleTest Test> Hit linear_closest(const GeometryView& view, const Ray& ray) {
    Hit best;
    if (!is_valid(ray))
        return best;
    const PreparedRay prepared(ray);
    const auto visit = [&](std::uint32_t geometry, std::uint32_t primitive) {
        PrimitiveHit hit{};
        if (!is_traceable(view, geometry, primitive))
            return;
        bool found = false;
        if (view.is_sphere(geometry)) {
            found = intersect_sphere(prepared, view.spheres[primitive], ray.tmax, hit);
        } else {
            const TriangleVertices t = view.vertices(geometry, primitive);
            found = intersect_triangle<Test>(prepared, t.a, t.b, t.c, ray.tmax, hit);
        }
        if (found && hit.t < best.t)
            best = {hit.t, hit.u, hit.v, geometry, primitive, invalid_id};
    };
    for (std::uint32_t g = 0; g < view.meshes.size(); ++g)
        for (std::uint32_t p = 0; p < view.meshes[g].triangles.size(); ++p)
            visit(g, p);
    for (std::uint32_t p = 0; p < view.spheres.size(); ++p)
        visit(view.sphere_geometry(), p);
    return best;
}

struct Named {
    std::string name;
    std::unique_ptr<Intersector> intersector;
};

/// naive, and sah in every quality and instruction set that there is.
std::vector<Named> own_intersectors(const GeometryView& view, TriangleTest test) {
    static const std::vector<Isa> isas = test::isas_here();
    std::vector<Named> all;
    const auto add = [&](AccelKind kind, BuildQuality quality, Isa isa) {
        const BuildOptions options{test, quality, isa, 1};
        all.push_back({std::string(name_of(kind)) + ' ' + std::string(name_of(quality)) + ' ' +
                           std::string(name_of(isa)),
                       make_intersector(kind, view, options)});
    };
    add(AccelKind::naive, BuildQuality::medium, Isa::automatic);
    for (const BuildQuality quality :
         {BuildQuality::fast, BuildQuality::medium, BuildQuality::high})
        for (const Isa isa : isas)
            if (isa != Isa::automatic)
                add(AccelKind::sah, quality, isa);
    return all;
}

/// Rays one by one and as streams give `expected`, to the bit.
void require_bits(const Named& one, const std::vector<Ray>& rays,
                  const std::vector<Hit>& expected) {
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> found(rays.size());
    one.intersector->closest(rays, hits);
    one.intersector->occluded(rays, found);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto same = [&](const Hit& hit, const char* how) {
            if (!same_bits(hit, expected[i]))
                throw Finding(one.name + how + ": " + text_of(hit) + ", expected " +
                              text_of(expected[i]) + ", " + text_of(rays[i]));
        };
        same(one.intersector->closest(rays[i]), "");
        same(hits[i], " as a stream");
        if (one.intersector->occluded(rays[i]) != expected[i].valid() ||
            (found[i] != 0) != expected[i].valid())
            throw Finding(one.name + ": occluded() is not closest().valid(), " + text_of(rays[i]));
    }
}

/// Brute force, through the referee's bounds.
void require_right(const GeometryView& view, const Ray& ray, const Hit& hit) {
    if (max_component(abs(ray.direction)) < 1e-30f)
        return; // depths along such a ray are not normal numbers, which the bounds suppose
    const auto exact = test::brute_force_closest(view, ray);
    if (exact) {
        const Judgement j = judge(view, exact->geometry, exact->primitive, ray);
        // From inside a sphere its far side is the one in range.
        const Crossing& crossing = j.near.in_range == Answer::yes ? j.near : j.far;
        const double latest = crossing.t + crossing.t_error;
        if (j.answer == Answer::yes && !(static_cast<double>(hit.t) <= latest))
            throw Finding("brute force has primitive " + std::to_string(exact->primitive) +
                          " at t " + std::to_string(exact->t) + ", naive " + text_of(hit) + ", " +
                          text_of(ray));
        if (j.answer == Answer::no)
            throw Finding("the referee denies the hit of brute force, " + text_of(ray));
    }
    if (!hit.valid())
        return;
    const Judgement j = judge(view, hit.geometry, hit.primitive, ray);
    const bool uv = view.is_sphere(hit.geometry) || are_right_uv(j, hit.u, hit.v);
    if (j.answer == Answer::no || !is_right_t(j, hit.t) || !uv)
        throw Finding("naive's hit is wrong: " + text_of(hit) + ", " + text_of(ray));
    if (j.answer == Answer::yes && !test::exact_hit(view, hit.geometry, hit.primitive, ray))
        throw Finding("the referee affirms a hit that brute force denies, " + text_of(ray));
}

/// Whether a ray leaves the range of float inside Embree (its README): directions and determinants
/// or a component of them below 1e-18, by which it does not divide (boxes are missed that begin as
/// near), determinants above 3e38, distances and t below 1e-30.
bool is_beyond_embree(const GeometryView& view, const Ray& ray, const Hit& hit) {
    const auto speed = static_cast<double>(max_component(abs(ray.direction)));
    for (int axis = 0; axis < 3; ++axis)
        if (const float c = std::fabs(ray.direction[axis]); c > 0 && c < 1e-18f)
            return true;
    double reach = 0;
    for (const MeshView& mesh : view.meshes)
        for (const Vec3& p : mesh.positions)
            if (is_finite(p))
                reach = std::max(reach, static_cast<double>(max_component(abs(p - ray.origin))));
    if (reach * reach * std::max(speed, 1.0) > 1e36 || speed < 1e-16)
        return true;
    if (hit.valid() && static_cast<double>(hit.t) * std::min(speed, 1.0) < 1e-30)
        return true;
    return hit.valid() && !view.is_sphere(hit.geometry) &&
           primitive_area(view, hit.geometry, hit.primitive) * speed < 1e-17;
}

void require_embree_agrees(const GeometryView& view, const Intersector& naive,
                           const std::vector<Ray>& rays, const std::vector<Hit>& expected) {
    const auto embree = make_intersector(AccelKind::embree, view, {.threads = 1});
    const Classifier classifier(view, naive, *embree);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit hit = embree->closest(rays[i]);
        if (is_beyond_embree(view, rays[i], expected[i]) || is_beyond_embree(view, rays[i], hit))
            continue;
        const Verdict verdict = classifier.closest(rays[i], expected[i], hit);
        if (!is_explained(verdict.agreement))
            throw Finding("embree and naive: " + std::string(name_of(verdict.agreement)) +
                          ", wrong: " + std::string(name_of(verdict.culprit)) + ", naive " +
                          text_of(expected[i]) + ", embree " + text_of(hit) + ", " +
                          text_of(rays[i]));
    }
}

} // namespace

int fuzz_intersectors(const std::uint8_t* data, std::size_t size) {
    const RayCase input = ray_case_of(data, size);
    const GeometryView view = input.geometry.view();
    for (const TriangleTest test : {TriangleTest::watertight, TriangleTest::moeller_trumbore}) {
        const bool watertight = test == TriangleTest::watertight;
        std::vector<Hit> expected;
        for (const Ray& ray : input.rays)
            expected.push_back(watertight
                                   ? linear_closest<TriangleTest::watertight>(view, ray)
                                   : linear_closest<TriangleTest::moeller_trumbore>(view, ray));
        const std::vector<Named> all = own_intersectors(view, test);
        for (const Named& one : all)
            require_bits(one, input.rays, expected);
        if (!watertight)
            continue;
        for (std::size_t i = 0; i < input.rays.size(); ++i)
            require_right(view, input.rays[i], expected[i]);
        if (input.with_embree)
            require_embree_agrees(view, *all.front().intersector, input.rays, expected);
    }
    return 0;
}

} // namespace plumb::fuzz
