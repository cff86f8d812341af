/// \file  Every class of disagreement, made on purpose and named right.

#include "accel/validate/referee.h"
#include "tests/accel/validate_support.h"

#include <algorithm>

namespace plumb::test {
namespace {

const Verdict explained_tie{Agreement::tie, Culprit::none};
const Verdict explained_edge{Agreement::shared_edge, Culprit::none};
const Verdict explained_range{Agreement::range, Culprit::none};
const Verdict explained_boundary{Agreement::boundary, Culprit::none};
const Verdict explained_ulps{Agreement::ulps, Culprit::none};
const Verdict missed{Agreement::miss, Culprit::second};
const Verdict invented{Agreement::false_hit, Culprit::second};
const Verdict inexact{Agreement::inexact, Culprit::second};
const Verdict leaked{Agreement::leak, Culprit::second};

/// The unit square of two triangles at z = 0; its diagonal runs from (-1,-1) to (1,1).
TestGeometry square() { return TestGeometry(plane({0, 0, 0}, 2, 1)); }

/// One triangle at height z with corners (0,0), (1,0), (0,1).
Mesh corner_triangle(float z) {
    Mesh mesh;
    mesh.add_triangle({0, 0, z}, {1, 0, z}, {0, 1, z});
    return mesh;
}

/// From above onto (x, y, 0).
Ray down(float x, float y) { return {{x, y, 2}, 0, {0, 0, -1}, infinity}; }

Defective::Defect t_moved_by(int ulps) {
    return [ulps](const Ray&, Hit hit) {
        hit.t = moved(hit.t, ulps);
        return hit;
    };
}

Defective::Defect other_primitive(std::uint32_t primitive) {
    return [primitive](const Ray&, Hit hit) {
        hit.primitive = primitive;
        return hit;
    };
}

TEST(Validate, SameAnswersAreEqual) {
    const Case none{square(), down(0.3f, 0.1f), [](const Ray&, Hit hit) { return hit; }};
    EXPECT_EQ(none.closest(), Verdict{});
    EXPECT_EQ(none.occluded(), Verdict{});
}

TEST(Validate, AFewUlpsAreRounding) {
    for (const int ulps : {-8, -1, 1, 2, 8})
        EXPECT_EQ((Case{square(), down(0.3f, 0.1f), t_moved_by(ulps)}).closest(), explained_ulps)
            << ulps;
}

TEST(Validate, ManyUlpsAreInexact) {
    for (const int ulps : {-1000, 100, 1000})
        EXPECT_EQ((Case{square(), down(0.3f, 0.1f), t_moved_by(ulps)}).closest(), inexact) << ulps;
    const Case swapped{square(), down(0.3f, 0.1f), t_moved_by(100)};
    EXPECT_EQ(swapped.closest_swapped(), (Verdict{Agreement::inexact, Culprit::first}));
}

TEST(Validate, BarycentricsCountAsWell) {
    const auto with_u = [](float by) {
        return [by](const Ray&, Hit hit) {
            hit.u += by;
            return hit;
        };
    };
    EXPECT_EQ((Case{square(), down(0.3f, 0.1f), with_u(2e-7f)}).closest(), explained_ulps);
    EXPECT_EQ((Case{square(), down(0.3f, 0.1f), with_u(1e-3f)}).closest(), inexact);
}

TEST(Validate, AGrazingHitMayBeOffByMore) {
    // At an angle of 1e-3, a distance of 10 is known to about 1000 times the rounding.
    const Ray grazing{{-10, 0.1f, 0.01f}, 0, {1, 0, -1e-3f}, infinity};
    EXPECT_EQ((Case{square(), grazing, t_moved_by(400)}).closest(), explained_ulps);
    EXPECT_EQ((Case{square(), grazing, t_moved_by(100000)}).closest(), inexact);
}

TEST(Validate, NotANumberIsInexact) {
    const auto nan = [](const Ray&, Hit hit) {
        hit.t = std::numeric_limits<float>::quiet_NaN();
        return hit;
    };
    EXPECT_EQ((Case{square(), down(0.3f, 0.1f), nan}).closest(), inexact);
}

TEST(Validate, ADroppedHitIsAMiss) {
    const Case dropped{square(), down(0.3f, 0.1f), miss_always};
    EXPECT_EQ(dropped.closest(), missed);
    EXPECT_EQ(dropped.occluded(), missed);
    EXPECT_EQ(dropped.closest_swapped(), (Verdict{Agreement::miss, Culprit::first}));
}

TEST(Validate, AHitBehindTheNearestIsAMiss) {
    TestGeometry two(corner_triangle(1));
    two.add(corner_triangle(0));
    const auto behind = [](const Ray&, Hit hit) {
        hit.geometry = 1;
        hit.t = 2;
        return hit;
    };
    EXPECT_EQ((Case{std::move(two), down(0.3f, 0.3f), behind}).closest(), missed);
}

TEST(Validate, AnInventedHitIsAFalseHit) {
    const auto invent = [](const Ray&, const Hit&) { return Hit{2, 0.3f, 0.3f, 0, 1, invalid_id}; };
    const Case beside{square(), down(1.5f, 0), invent};
    EXPECT_EQ(beside.closest(), invented);
    EXPECT_EQ(beside.occluded(), invented);
    // In front of the hit that is there, with ids that do not exist.
    EXPECT_EQ((Case{square(), down(0.3f, 0.1f), other_primitive(77)}).closest(), invented);
    // Where the ray is not valid.
    EXPECT_EQ((Case{square(), {{0, 0, 2}, 0, {0, 0, 0}, infinity}, invent}).closest(), invented);
}

TEST(Validate, AHitBeyondTheRangeIsAFalseHit) {
    Ray ray = down(0.3f, 0.1f);
    ray.tmax = 1.9f;
    const auto invent = [](const Ray&, const Hit&) {
        return Hit{1.9f, 0.3f, 0.1f, 0, 0, invalid_id};
    };
    EXPECT_EQ((Case{square(), ray, invent}).closest(), invented);
}

TEST(Validate, AnyHitWithoutAPrimitiveIsAFalseHit) {
    const TestGeometry geometry = square();
    const auto sound = make_intersector(AccelKind::naive, geometry.view());
    class Pessimist final : public Intersector {
      public:
        using Intersector::closest;
        using Intersector::occluded;
        [[nodiscard]] Hit closest(const Ray&) const override { return {}; }
        [[nodiscard]] bool occluded(const Ray&) const override { return true; }
        [[nodiscard]] AccelStats stats() const override { return {}; }
    } const pessimist;
    const ValidatingIntersector both(geometry.view(), *sound, pessimist);
    EXPECT_FALSE(static_cast<const Intersector&>(both).occluded(down(1.5f, 0)));
    EXPECT_EQ(both.report().counts[static_cast<std::size_t>(Agreement::false_hit)][2], 1u);
}

TEST(Validate, TheNeighbourAcrossAnEdgeIsExplainedAtTheEdgeOnly) {
    const auto neighbour = [](const Ray&, Hit hit) {
        hit.primitive = 1 - hit.primitive;
        std::swap(hit.u,
                  hit.v); // the diagonal is the edge of both that leads to their corner 2 or 1
        return hit;
    };
    const Case on_edge{square(), down(0.25f, 0.25f), neighbour};
    EXPECT_EQ(on_edge.closest(), explained_edge);
    // Off the diagonal, the neighbour is no hit.
    EXPECT_EQ((Case{square(), down(0.3f, 0.1f), neighbour}).closest(), invented);
}

TEST(Validate, ACoplanarCopyIsATie) {
    EXPECT_EQ((Case{TestGeometry(repeated_triangle(5)),
                    Ray{{0.2f, 0.2f, 2}, 0, {0, 0, -1}, infinity}, other_primitive(3)})
                  .closest(),
              explained_tie);
}

TEST(Validate, AnOutlineIsABoundary) {
    const Case on_outline{TestGeometry(corner_triangle(0)), down(0.25f, 0), miss_always};
    EXPECT_EQ(on_outline.closest(), explained_boundary);
    EXPECT_EQ(on_outline.occluded(), explained_boundary);
    EXPECT_EQ((Case{square(), down(1, 0.25f), miss_always}).closest(), explained_boundary);
    EXPECT_EQ((Case{TestGeometry(corner_triangle(0)), down(0.25f, 1e-4f), miss_always}).closest(),
              missed);
}

TEST(Validate, AMissBehindAnOutlineIsAMiss) {
    TestGeometry two(corner_triangle(1));
    two.add(plane({0, 0, 0}, 4, 1));
    const Case nothing{std::move(two), down(0.25f, 0), miss_always};
    EXPECT_EQ(nothing.closest(), missed);
    EXPECT_EQ(nothing.occluded(), missed);
}

TEST(Validate, NothingAtAClosedEdgeOrCornerIsALeak) {
    EXPECT_EQ((Case{square(), down(0.25f, 0.25f), miss_always}).closest(), leaked);
    EXPECT_EQ((Case{square(), down(0.25f, 0.25f), miss_always}).occluded(), leaked);
    const Case at_corner{TestGeometry(plane({0, 0, 0}, 2, 4)), down(0.5f, -0.5f), miss_always};
    EXPECT_EQ(at_corner.closest(), leaked);
    const Case at_outer_corner{TestGeometry(plane({0, 0, 0}, 2, 4)), down(1, 1), miss_always};
    EXPECT_EQ(at_outer_corner.closest(), explained_boundary);
    // The edges of a box that faces the ray with one side only are an outline.
    const Case silhouette{TestGeometry(box({-1, -1, -1}, {1, 1, 1})), down(1, 0.3f), miss_always};
    EXPECT_EQ(silhouette.closest(), explained_boundary);
}

TEST(Validate, TheEndsOfTheRangeAreExplainedAtTheHitOnly) {
    Ray ray = down(0.3f, 0.1f);
    ray.tmax = 2;
    EXPECT_EQ((Case{square(), ray, miss_always}).closest(), explained_range);
    EXPECT_EQ((Case{square(), ray, miss_always}).occluded(), explained_range);
    ray.tmax = 2.001f;
    EXPECT_EQ((Case{square(), ray, miss_always}).closest(), missed);
    ray.tmin = std::nextafter(2.0f, 0.0f);
    EXPECT_EQ((Case{square(), ray, miss_always}).closest(), explained_range);
    // Whatever is around the ray: no leak at a closed edge, no outline at the outer one.
    for (const float x : {0.25f, 1.0f}) {
        Ray at_edge = down(x, 0.25f);
        at_edge.tmax = 2;
        EXPECT_EQ((Case{square(), at_edge, miss_always}).closest(), explained_range);
    }
}

TestGeometry ball() {
    TestGeometry geometry;
    geometry.add(Sphere{{0, 0, 0}, 1});
    return geometry;
}

TEST(Validate, SpheresAreJudgedToo) {
    EXPECT_EQ((Case{ball(), down(0.3f, 0.1f), miss_always}).closest(), missed);
    EXPECT_EQ((Case{ball(), down(0.3f, 0.1f), t_moved_by(2)}).closest(), explained_ulps);
    EXPECT_EQ((Case{ball(), down(0.3f, 0.1f), t_moved_by(1000)}).closest(), inexact);
    EXPECT_EQ((Case{ball(), down(1, 0), miss_always}).closest(), explained_boundary);
    EXPECT_EQ((Case{ball(), down(1.1f, 0),
                    [](const Ray&, const Hit&) { return Hit{2, 0, 0, 0, 0, invalid_id}; }})
                  .closest(),
              invented);
}

TEST(Validate, TheFarSideOfASphereCountsWhereTheRangeHidesTheNear) {
    const auto far_side = [](const Ray&, Hit hit) {
        hit.t = 3;
        return hit;
    };
    Ray ray = down(0, 0);
    EXPECT_EQ((Case{ball(), ray, far_side}).closest(), inexact);
    ray.tmin = std::nextafter(1.0f, 0.0f); // the near side at t = 1 is only just within
    EXPECT_EQ((Case{ball(), ray, far_side}).closest(), explained_range);
    EXPECT_EQ((Case{ball(), ray, miss_always}).closest(), missed); // one of the two is there
    ray.tmin = 2;
    ray.tmax = 3; // from inside, up to the far side
    EXPECT_EQ((Case{ball(), ray, miss_always}).closest(), explained_range);
}

TEST(Referee, AgreesWithTheOracleWhereItIsSure) {
    const TestGeometry scene = mixed_scene(201);
    const GeometryView view = scene.view();
    Random random(202);
    int yes = 0, no = 0, either = 0, wrong = 0;
    for (int i = 0; i < 300; ++i) {
        const Ray ray = random_ray(random);
        for (std::uint32_t g = 0; g <= view.sphere_geometry(); ++g)
            for (std::uint32_t p = 0; p < 400; ++p) {
                if (p >=
                    (view.is_sphere(g) ? view.spheres.size() : view.meshes[g].triangles.size()))
                    break;
                const Judgement j = judge(view, g, p, ray);
                const auto exact = exact_hit(view, g, p, ray);
                yes += j.answer == Answer::yes;
                no += j.answer == Answer::no;
                either += j.answer == Answer::either;
                wrong += (j.answer == Answer::yes && !exact) || (j.answer == Answer::no && exact);
                if (j.answer == Answer::yes && exact)
                    wrong += std::min(std::fabs(j.near.t - exact->t),
                                      std::fabs(j.far.t - exact->t)) > 1e-3 * j.near.t_error;
            }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(yes, 300);
    EXPECT_GT(no, 10000);
    EXPECT_LT(either, yes / 10); // most are sure
}

} // namespace
} // namespace plumb::test
