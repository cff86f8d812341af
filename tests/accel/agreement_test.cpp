/// \file  Agreement across implementations: naive and sah to the bit, Embree within 8 ulp.

#include "tests/accel/intersector_suite.h"

#include <algorithm>
#include <array>

namespace plumb::test {
namespace {

struct NamedScene {
    const char* name;
    TestGeometry geometry;
};

/// Everything with coordinates of about [-1, 1], so that random_ray meets it.
std::vector<NamedScene> all_scenes() {
    std::vector<NamedScene> scenes;
    Random random(111);
    const auto add = [&](const char* name, Mesh mesh) {
        scenes.push_back({name, TestGeometry(std::move(mesh))});
    };
    scenes.push_back({"mixed", mixed_scene(112)});
    add("soup", triangle_soup(random, 3000, 0.1f));
    add("needles", needles(random, 1000, 1e-3f));
    add("large triangles", triangle_soup(random, 200, 3));
    add("closed sphere", closed_sphere({0, 0, 0}, 1, 40));
    add("plane", plane({0, 0, 0}, 2, 30));
    add("room", box({-1.5f, -1.5f, -1.5f}, {1.5f, 1.5f, 1.5f}));
    add("copies", repeated_triangle(500));
    add("nested boxes", nested_boxes(100));
    add("displaced sphere", displaced_sphere({0, 0, 0}, 1, 60));
    TestGeometry spheres;
    for (Sphere s : sphere_grid(12, 0.6f)) // overlapping
        spheres.add(Sphere{0.15f * s.center - Vec3{0.8f, 0.8f, 0.8f}, 0.15f * s.radius});
    scenes.push_back({"spheres", std::move(spheres)});
    return scenes;
}

/// Random rays, rays at vertices and rays at edges, in turn.
Ray any_ray(Random& random, const TestGeometry& scene, int i) {
    Ray ray = random_ray(random);
    if (i % 4 < 2 || scene.meshes().empty())
        return ray;
    const auto meshes = static_cast<std::uint32_t>(scene.meshes().size());
    const Mesh& mesh = scene.meshes()[random.index(meshes)];
    const Triangle t =
        mesh.triangles[random.index(static_cast<std::uint32_t>(mesh.triangles.size()))];
    const Vec3 a = mesh.positions[t.a], b = mesh.positions[t.b];
    const float s = i % 4 == 2 ? 0.0f : random.uniform();
    ray.direction = a + s * (b - a) - ray.origin;
    return length(ray.direction) > 0 ? ray : random_ray(random);
}

int different_bits(const Intersector& a, const Intersector& b, const TestGeometry& scene,
                   int rays) {
    Random random(113);
    int differ = 0;
    for (int i = 0; i < rays; ++i) {
        const Ray ray = any_ray(random, scene, i);
        differ += !same_bits(a.closest(ray), b.closest(ray));
        differ += a.occluded(ray) != b.occluded(ray);
    }
    return differ;
}

/// sah as the CPU traverses it, and the two trees that a device does.
std::vector<std::unique_ptr<Intersector>> sah_trees(const GeometryView& view, TriangleTest test) {
    std::vector<std::unique_ptr<Intersector>> trees;
    trees.push_back(make_intersector(AccelKind::sah, view, {test}));
    trees.push_back(std::make_unique<BinaryOnHost>(build_sah(view), test));
    trees.push_back(std::make_unique<CompressedOnHost>(build_compressed(view), test));
    return trees;
}

class NaiveAndSah : public testing::TestWithParam<TriangleTest> {};
INSTANTIATE_TEST_SUITE_P(Every, NaiveAndSah,
                         testing::Values(TriangleTest::watertight, TriangleTest::moeller_trumbore),
                         [](const auto& test) {
                             return test.param == TriangleTest::watertight ? "watertight"
                                                                           : "moellerTrumbore";
                         });

TEST_P(NaiveAndSah, GiveTheSameBitsInEveryScene) {
    for (const NamedScene& scene : all_scenes()) {
        const GeometryView view = scene.geometry.view();
        const auto naive = make_intersector(AccelKind::naive, view, {GetParam()});
        for (const auto& sah : sah_trees(view, GetParam()))
            EXPECT_EQ(different_bits(*naive, *sah, scene.geometry, 40000), 0) << scene.name;
    }
}

TEST_P(NaiveAndSah, GiveTheSameBitsFarFromTheOriginAndInTinyAndHugeScenes) {
    for (const float scale : {1e-12f, 1e-3f, 1e6f, 1e11f, 4e11f, 1e12f})
        for (const float shift : {0.0f, 1e4f}) {
            Random random(114);
            Mesh mesh = triangle_soup(random, 500, 0.2f);
            for (Vec3& p : mesh.positions)
                p = scale * (p + Vec3{shift, -shift, 0.5f * shift});
            const TestGeometry scene(std::move(mesh));
            const auto naive = make_intersector(AccelKind::naive, scene.view(), {GetParam()});
            const auto trees = sah_trees(scene.view(), GetParam());
            int differ = 0, hits = 0;
            for (int i = 0; i < 20000; ++i) {
                Ray ray = random_ray(random);
                ray.origin = scale * (ray.origin + Vec3{shift, -shift, 0.5f * shift});
                const Hit a = naive->closest(ray);
                for (const auto& sah : trees) {
                    differ += !same_bits(a, sah->closest(ray));
                    differ += sah->occluded(ray) != a.valid();
                }
                hits += a.valid();
            }
            EXPECT_EQ(differ, 0) << scale << ' ' << shift;
            EXPECT_GT(hits, 500) << scale << ' ' << shift;
        }
}

TEST_P(NaiveAndSah, GiveTheSameBitsOnGarbage) {
    Random random(115);
    const auto number = [&] { return std::bit_cast<float>(random.bits()); };
    int differ = 0;
    for (int s = 0; s < 300; ++s) {
        Mesh mesh = triangle_soup(random, 20, 0.5f);
        for (int i = 0; i < 30; ++i)
            mesh.positions[random.index(60)][i % 3] = number();
        TestGeometry scene(std::move(mesh));
        scene.add(Sphere{{number(), 0, 0}, number()});
        const auto naive = make_intersector(AccelKind::naive, scene.view(), {GetParam()});
        for (const auto& sah : sah_trees(scene.view(), GetParam()))
            differ += different_bits(*naive, *sah, scene, 100);
    }
    EXPECT_EQ(differ, 0);
}

/// Corners that two triangles have at the same place.
int shared_corners(const GeometryView& view, const Hit& a, const Hit& b) {
    if (view.is_sphere(a.geometry) || view.is_sphere(b.geometry))
        return 0;
    const TriangleVertices p = view.vertices(a.geometry, a.primitive),
                           q = view.vertices(b.geometry, b.primitive);
    int shared = 0;
    for (const Vec3& x : {p.a, p.b, p.c})
        for (const Vec3& y : {q.a, q.b, q.c})
            shared += x == y;
    return shared;
}

/// |cosine| between a ray and the normal of the triangle that it hit.
double cosine(const GeometryView& view, const Ray& ray, const Hit& hit) {
    const TriangleVertices t = view.vertices(hit.geometry, hit.primitive);
    const Vec3 n = safe_normalize(cross(t.b - t.a, t.c - t.a));
    return static_cast<double>(std::fabs(dot(n, safe_normalize(ray.direction))));
}

/// Difference in t in ulps of the distance or of the triangle's size, whichever is the larger: a
/// ray that starts within a triangle's reach knows its t to the rounding of the triangle.
double ulps_of_distance(const GeometryView& view, const Ray& ray, const Hit& a, const Hit& b) {
    const TriangleVertices t = view.vertices(a.geometry, a.primitive);
    const double size = static_cast<double>(max_component(vertex_bounds(t.a, t.b, t.c).extent()));
    const double scale =
        std::max(static_cast<double>(a.t), size / static_cast<double>(length(ray.direction)));
    return std::fabs(static_cast<double>(a.t) - static_cast<double>(b.t)) / scale * 0x1p23;
}

struct Disagreements {
    int steep = 0, far = 0; ///< same primitive, |cosine| > 0.1; of these t more than 8 ulp apart
    int grazing_far = 0;    ///< the same for flatter hits, the limit divided by the cosine
    int neighbour = 0;      ///< another primitive across a shared edge or vertex (allowed)
    int silhouette = 0;     ///< rounding decides whether an outline is hit (allowed, rare)
    int wrong = 0;
    double worst = 0; ///< ulps of the steep ones
};

/// Whether the ray passes an edge of a triangle, inside or out, within what rounding explains: 1e-3
/// of the triangle, more where the ray grazes it and its projection is thin, all of it edge-on.
bool near_an_edge(const GeometryView& view, const Ray& ray, const Hit& hit) {
    const double c = cosine(view, ray, hit);
    if (c < 1e-4)
        return true;
    const double slack = std::clamp(1e-4 / c, 1e-3, 0.5);
    Ray line = ray;
    line.tmin = 0;
    line.tmax = infinity;
    const auto on = exact_hit(view, hit.geometry, hit.primitive, line, slack);
    return on && on->edge < slack;
}

/// Classifies what two intersectors say, by the oracle where they differ.
void compare(const GeometryView& view, const Ray& ray, const Hit& a, const Hit& b,
             Disagreements& d) {
    if (!a.valid() && !b.valid())
        return;
    if (a.valid() && b.valid() && a.geometry == b.geometry && a.primitive == b.primitive) {
        const double ulps = ulps_of_distance(view, ray, a, b), c = cosine(view, ray, a);
        if (c < 0.1) {
            d.grazing_far += ulps * c > 8;
            return;
        }
        ++d.steep;
        d.worst = std::max(d.worst, ulps);
        d.far += ulps > 8;
        return;
    }
    if (a.valid() && b.valid() && shared_corners(view, a, b) > 0 && near_an_edge(view, ray, a) &&
        near_an_edge(view, ray, b)) {
        ++d.neighbour;
        return;
    }
    // Rounding must have lost the nearer hit: it grazes an edge or is flat enough for t to differ.
    const Hit& nearer = a.t <= b.t ? a : b;
    (near_an_edge(view, ray, nearer) ? d.silhouette : d.wrong) += 1;
}

TEST(EmbreeAndSah, AgreeOnADisplacedSphereOf100000Triangles) {
    const TestGeometry scene(displaced_sphere({0, 0, 0}, 1, 160));
    ASSERT_GT(scene.meshes()[0].triangles.size(), 100000u);
    const GeometryView view = scene.view();
    const auto sah = make_intersector(AccelKind::sah, view),
               embree = make_intersector(AccelKind::embree, view);
    Random random(116);
    Disagreements aimed, free;
    int hits = 0;
    for (int i = 0; i < 200000; ++i) {
        const Ray ray = any_ray(random, scene, i);
        const Hit a = sah->closest(ray), b = embree->closest(ray);
        hits += a.valid();
        compare(view, ray, a, b, i % 4 < 2 ? free : aimed);
    }
    EXPECT_GT(hits, 100000);
    for (const Disagreements& d : {aimed, free}) {
        EXPECT_GT(d.steep, 40000);
        EXPECT_EQ(d.wrong, 0);
        EXPECT_EQ(d.far, 0) << "worst: " << d.worst << " ulp";
        EXPECT_EQ(d.grazing_far, 0);
    }
    // Random rays meet an outline to within rounding hardly ever; of those aimed at vertices and
    // edges some lie on the outline.
    EXPECT_LE(free.silhouette, 10);
    EXPECT_LE(free.neighbour, 100);
    EXPECT_LE(aimed.silhouette, 2000);
}

TEST(EmbreeAndSah, GiveTheSameBitsOnSpheres) {
    // The very same sphere test runs inside Embree.
    TestGeometry scene;
    Random random(117);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 center = random.point(-1, 1);
        scene.add(Sphere{center, random.uniform(0.01f, 0.1f)});
    }
    const auto sah = make_intersector(AccelKind::sah, scene.view()),
               embree = make_intersector(AccelKind::embree, scene.view());
    EXPECT_EQ(different_bits(*sah, *embree, scene, 100000), 0);
}

TEST(EmbreeAndSah, EmbreeRefusesMoellerTrumbore) {
    const TestGeometry scene = mixed_scene(118);
    EXPECT_THROW(
        (void)make_intersector(AccelKind::embree, scene.view(), {TriangleTest::moeller_trumbore}),
        std::runtime_error);
}

} // namespace
} // namespace plumb::test
