/// \file  Suite of every Intersector: a stream's answers are those of its rays one by one, to the
/// bit.

#include "accel/sah/build_binary.h"
#include "accel/sah/collapse.h"
#include "tests/accel/intersector_suite.h"

#include <algorithm>
#include <array>
#include <limits>

namespace plumb::test {
namespace {

class IntersectorStreams : public IntersectorTest {};
INSTANTIATE_TEST_SUITE_P(Every, IntersectorStreams, own_configs(), config_name);

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

using Rays = std::vector<Ray>;

/// Camera rays through a square of `blocks` x `blocks` blocks of 4 x 4 pixels, block by block.
Rays pinhole_rays(Vec3 eye, Vec3 target, int blocks, float width) {
    const Vec3 ahead = normalize(target - eye);
    const Vec3 right =
        normalize(cross(ahead, std::fabs(ahead.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{1, 0, 0}));
    const Vec3 up = cross(right, ahead);
    Rays rays;
    const float pixel = width / (4 * static_cast<float>(blocks));
    for (int block = 0; block < blocks * blocks; ++block)
        for (int i = 0; i < 16; ++i) {
            const int x = block % blocks * 4 + i % 4, y = block / blocks * 4 + i / 4;
            const Vec3 d = ahead + (pixel * static_cast<float>(x) - 0.5f * width) * right +
                           (pixel * static_cast<float>(y) - 0.5f * width) * up;
            rays.push_back({eye, 0, normalize(d), infinity});
        }
    return rays;
}

/// From points near each other towards points of a small light, at most as far as the light.
Rays light_rays(Random& random, std::size_t count) {
    Rays rays;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 from = Vec3{0.3f, -0.2f, 0.1f} + random.point(-0.05f, 0.05f);
        const Vec3 to = Vec3{0.2f, 1.9f, 0.3f} + random.point(-0.2f, 0.2f);
        rays.push_back({from, 0, to - from, 1});
    }
    return rays;
}

Rays incoherent_rays(Random& random, std::size_t count) {
    Rays rays;
    for (std::size_t i = 0; i < count; ++i)
        rays.push_back(random_ray(random));
    return rays;
}

/// From planes of furnished_room, many along them.
Rays rays_along_planes(Random& random, std::size_t count) {
    constexpr float at[]{-1.5f, -0.5f, 0, 1.5f}, along[]{0, -0.0f, 1, -1};
    Rays rays;
    for (std::size_t i = 0; i < count; ++i) {
        Ray ray = random_ray(random);
        for (int axis = 0; axis < 3; ++axis) {
            if (random.index(2) == 0)
                ray.origin[axis] = at[random.index(4)];
            if (random.index(2) == 0)
                ray.direction[axis] = along[random.index(4)];
        }
        rays.push_back(ray);
    }
    return rays;
}

/// Something else in place of a few rays of a coherent stream, or of all that differ from it in one
/// respect: what a packet must notice.
Ray odd_one(Random& random, Ray ray) {
    const int axis = static_cast<int>(random.index(3));
    switch (random.index(16)) {
    case 0: ray.origin[axis] = nan; break;
    case 1: ray.direction[axis] = nan; break;
    case 2: ray.direction = {}; break;
    case 3: ray.direction = {-0.0f, 0, -0.0f}; break;
    case 4: ray.tmin = 5, ray.tmax = 4; break;
    case 5: ray.tmin = nan; break;
    case 6: ray.tmax = nan; break;
    case 7: ray.tmin = infinity, ray.tmax = 0; break;
    case 8: ray.direction[axis] = random.index(2) == 0 ? 0.0f : -0.0f; break;
    case 9: { // along an axis
        const float length = ray.direction[axis];
        ray.direction = {};
        ray.direction[axis] = length;
        break;
    }
    case 10: ray.direction = 0x1p-41f * ray.direction; break;
    case 11: ray.direction = 0x1p41f * ray.direction; break;
    case 12: ray.origin[axis] = std::copysign(0x1.1p40f, ray.origin[axis]); break;
    case 13: ray.direction[axis] = -ray.direction[axis]; break;                    // other signs
    case 14: std::swap(ray.direction[axis], ray.direction[(axis + 1) % 3]); break; // other kz
    default: ray.tmin = 0.3f, ray.tmax = random.uniform(0.3f, 4); break;
    }
    return ray;
}

Rays with_odd_ones(Random& random, Rays rays, float share) {
    for (Ray& ray : rays)
        if (random.uniform() < share)
            ray = odd_one(random, ray);
    return rays;
}

struct Answers {
    int hits = 0, wrong = 0, wrong_any = 0;
};

/// Traces a stream both ways; the single rays' answers are right by the other tests of the suite.
void compare(const Intersector& accel, std::span<const Ray> rays, Answers& answers) {
    const Hit stale{1, 2, 3, 4, 5, 6};
    std::vector<Hit> hits(rays.size() + 1, stale);
    std::vector<std::uint8_t> found(rays.size() + 1, 7);
    accel.closest(rays, std::span(hits).first(rays.size()));
    accel.occluded(rays, std::span(found).first(rays.size()));
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit hit = accel.closest(rays[i]);
        answers.hits += hit.valid();
        answers.wrong += !same_bits(hits[i], hit);
        answers.wrong_any += found[i] != (accel.occluded(rays[i]) ? 1 : 0);
    }
    answers.wrong += !same_bits(hits.back(), stale); // beyond the end
    answers.wrong_any += found.back() != 7;
}

/// Streams of all kinds through a scene of coordinates of about [-1, 1].
std::vector<Rays> all_streams(std::uint64_t seed) {
    Random random(seed);
    std::vector<Rays> streams;
    const Vec3 eyes[]{{0, 0, 3}, {2, 1.5f, -2}, {0.1f, 0.1f, 0.1f}, {-3, 0.01f, 0.02f}};
    for (const Vec3 eye : eyes) {
        streams.push_back(pinhole_rays(eye, {0.02f, 0.01f, 0}, 10, 1));
        streams.push_back(pinhole_rays(eye, {0.3f, 0.2f, 0.1f}, 4, 1e-3f)); // all but parallel
    }
    streams.push_back(light_rays(random, 1000));
    streams.push_back(incoherent_rays(random, 1000));
    streams.push_back(rays_along_planes(random, 1000));
    for (const float scale : {0x1p-39f, 0x1p-41f, 0x1p39f, 0x1p41f}) {
        streams.push_back(pinhole_rays({0, 0, 3}, {0.02f, 0.01f, 0}, 4, 1));
        for (Ray& ray : streams.back())
            ray.direction = scale * ray.direction;
    }
    const std::size_t pure = streams.size();
    for (std::size_t i = 0; i < pure; ++i)
        for (const float share : {0.03f, 0.3f})
            streams.push_back(with_odd_ones(random, streams[i], share));
    Rays mixture = pinhole_rays({0, 0, 3}, {0, 0, 0}, 4, 1);
    for (std::size_t i = 0; i < mixture.size(); i += 1 + random.index(20))
        mixture[i] = random_ray(random);
    streams.push_back(std::move(mixture));
    return streams;
}

TestGeometry many_meshes() {
    Random random(132);
    TestGeometry scene;
    for (int i = 0; i < 60; ++i) {
        scene.add(i % 4 == 1 ? Mesh{} : triangle_soup(random, 1 + random.index(30), 0.3f));
        if (i % 7 == 0)
            scene.add(Mesh{});
    }
    return scene;
}

/// Copies of the same triangles in several meshes, in other orders.
TestGeometry tied_meshes() {
    Random random(133);
    const Mesh soup = triangle_soup(random, 200, 0.5f);
    TestGeometry scene;
    for (int copy = 0; copy < 4; ++copy) {
        Mesh mesh = soup;
        if (copy % 2 == 1)
            std::reverse(mesh.triangles.begin(), mesh.triangles.end());
        scene.add(std::move(mesh));
        scene.add(Sphere{{0.2f, 0, 0}, 0.3f});
    }
    return scene;
}

TestGeometry degenerate_scene() {
    Random random(134);
    Mesh mesh = plane({0, 0, 0}, 2, 8); // vertices and edges at round coordinates
    for (int i = 0; i < 300; ++i) {
        const Vec3 a = random.point(-1, 1), d = random.direction();
        mesh.add_triangle(a, a, a + d);
        mesh.add_triangle(a, a + d, a + 0.5f * d);
    }
    return TestGeometry(std::move(mesh));
}

/// A tree of a root and its leaves: a room with a box in it, both in two meshes of which one lies
/// in the other's walls with its triangles in another order, and empty meshes between.
TestGeometry furnished_room() {
    TestGeometry scene;
    for (const bool again : {false, true}) {
        for (Mesh mesh :
             {box({-1.5f, -1.5f, -1.5f}, {1.5f, 2, 1.5f}), box({-0.5f, -1.5f, -0.5f}, {0, 0, 0})}) {
            if (again)
                std::reverse(mesh.triangles.begin(), mesh.triangles.end());
            scene.add(std::move(mesh));
            for (int i = 0; i < 3; ++i)
                scene.add(Mesh{});
        }
    }
    return scene;
}

struct NamedScene {
    const char* name;
    TestGeometry geometry;
};

std::vector<NamedScene> stream_scenes() {
    Random random(135);
    std::vector<NamedScene> scenes;
    scenes.push_back({"mixed", mixed_scene(136)});
    scenes.push_back({"many meshes", many_meshes()});
    scenes.push_back({"ties", tied_meshes()});
    scenes.push_back({"degenerate", degenerate_scene()});
    scenes.push_back({"room", TestGeometry(box({-1.5f, -1.5f, -1.5f}, {1.5f, 2, 1.5f}))});
    scenes.push_back({"furnished room", furnished_room()});
    scenes.push_back({"displaced sphere", TestGeometry(displaced_sphere({0, 0, 0}, 1, 60))});
    scenes.push_back({"needles", TestGeometry(needles(random, 1000, 0.02f))});
    TestGeometry spheres;
    for (const Sphere& s : sphere_grid(8, 0.6f))
        spheres.add(Sphere{0.25f * s.center - Vec3{0.9f, 0.9f, 0.9f}, 0.25f * s.radius});
    scenes.push_back({"spheres", std::move(spheres)});
    return scenes;
}

TEST(IntersectorStreamsScenes, FurnishedRoomIsATreeOfOneLevel) {
    const TestGeometry room = furnished_room();
    for (const BuildQuality quality :
         {BuildQuality::fast, BuildQuality::medium, BuildQuality::high}) {
        const BinaryBvh binary = build_binary(room.view(), {quality, 1});
        EXPECT_TRUE(collapse(binary, room.view(), 1).view().one_level) << name_of(quality);
    }
}

TEST_P(IntersectorStreams, AnswerAsTheirRaysDoOneByOne) {
    const std::vector<Rays> streams = all_streams(137);
    for (const NamedScene& scene : stream_scenes()) {
        const auto accel = build(scene.geometry.view());
        Answers answers;
        for (const Rays& rays : streams)
            compare(*accel, rays, answers);
        EXPECT_EQ(answers.wrong, 0) << scene.name;
        EXPECT_EQ(answers.wrong_any, 0) << scene.name;
        EXPECT_GT(answers.hits, 1000) << scene.name;
    }
}

TEST_P(IntersectorStreams, OfAnySizeAnswerAsTheirRaysDo) {
    const TestGeometry scene = mixed_scene(138);
    const auto accel = build(scene.view());
    Random random(139);
    const Rays coherent = pinhole_rays({0, 0, 3}, {0.02f, 0.01f, 0}, 20, 1);
    const Rays incoherent = incoherent_rays(random, 5000);
    const Rays odd = with_odd_ones(random, coherent, 0.1f);
    Answers answers;
    for (const Rays& rays : {coherent, incoherent, odd})
        for (const std::size_t size :
             {0u, 1u, 2u, 3u, 4u, 5u, 7u, 8u, 9u, 15u, 16u, 17u, 31u, 33u, 1000u, 5000u})
            for (const std::size_t first : {0u, 5u, 640u})
                compare(*accel,
                        std::span(rays).subspan(first).first(std::min(size, rays.size() - first)),
                        answers);
    EXPECT_EQ(answers.wrong, 0);
    EXPECT_EQ(answers.wrong_any, 0);
    EXPECT_GT(answers.hits, 10000);
}

/// Rays at vertices and along edges, where edge functions are zero and neighbours tie.
TEST_P(IntersectorStreams, AimedAtVerticesAndEdgesAnswerAsTheirRaysDo) {
    const Mesh mesh = plane({0, 0, 0}, 2, 16);
    const TestGeometry scene(mesh);
    const auto accel = build(scene.view());
    Random random(140);
    Rays rays;
    for (int block = 0; block < 200; ++block) {
        const Vec3 eye = Vec3{0.25f, -0.5f, 2} + random.point(-0.1f, 0.1f);
        const std::uint32_t at = random.index(static_cast<std::uint32_t>(mesh.triangles.size()));
        for (int i = 0; i < 16; ++i) {
            const Triangle t = mesh.triangles[at];
            const Vec3 a = mesh.positions[t.a], b = mesh.positions[t.b];
            const Vec3 to = a + (i % 2 == 0 ? 0.0f : random.uniform()) * (b - a);
            rays.push_back({i % 4 == 0 ? Vec3{to.x, to.y, 2} : eye, 0, to - eye, infinity});
        }
    }
    Answers answers;
    compare(*accel, rays, answers);
    EXPECT_EQ(answers.wrong, 0);
    EXPECT_EQ(answers.wrong_any, 0);
    EXPECT_GT(answers.hits, 2000);
}

/// Rays as the limit cases of packets: the longest component shared by two axes, components just
/// below and above 2^-30 of it, tmin = -0, tmax at the hit and just before.
TEST_P(IntersectorStreams, AtTheLimitsOfPacketsAnswerAsTheirRaysDo) {
    const TestGeometry scene = tied_meshes();
    const auto accel = build(scene.view());
    Random random(141);
    Rays rays;
    for (int block = 0; block < 400; ++block) {
        const Vec3 eye = random.point(-1, 1);
        Vec3 d = random.direction();
        const int axis = static_cast<int>(random.index(3)), other = (axis + 1) % 3;
        for (int i = 0; i < 16; ++i) {
            Ray ray{eye + 1e-3f * random.point(-1, 1), 0, d + 1e-3f * random.point(-1, 1),
                    infinity};
            if (block % 4 == 0) { // equal lengths, or one float apart; half never above
                const float longest = std::fabs(ray.direction[axis]);
                const bool above = i % 3 == 2 && block % 8 == 0;
                ray.direction[other] = std::copysign(
                    i % 3 == 1 ? longest : std::nextafter(longest, above ? 2.0f : 0.0f), d[other]);
            }
            if (block % 4 == 1)
                ray.direction[axis] = std::copysign(
                    (i % 5 == 0 ? 0x1.8p-31f : 0x1.4p-30f) * length(ray.direction), d[axis]);
            if (block % 4 == 2) {
                const Hit hit = accel->closest(ray);
                ray.tmin = -0.0f;
                ray.tmax = i % 2 == 0 ? hit.t : std::nextafter(hit.t, 0.0f);
            }
            rays.push_back(ray);
        }
    }
    Answers answers;
    compare(*accel, rays, answers);
    EXPECT_EQ(answers.wrong, 0);
    EXPECT_EQ(answers.wrong_any, 0);
    EXPECT_GT(answers.hits, 2000);
}

TEST_P(IntersectorStreams, InAnEmptySceneMiss) {
    const auto accel = build(GeometryView{});
    Answers answers;
    compare(*accel, pinhole_rays({0, 0, 3}, {0, 0, 0}, 4, 1), answers);
    EXPECT_EQ(answers.hits + answers.wrong + answers.wrong_any, 0);
}

/// Every instruction set and quality against naive: one stream, the same bits.
TEST_P(IntersectorStreams, GiveTheBitsOfNaive) {
    const std::vector<Rays> streams = all_streams(142);
    for (const NamedScene& scene : stream_scenes()) {
        const auto accel = build(scene.geometry.view());
        const auto naive =
            make_intersector(AccelKind::naive, scene.geometry.view(), {GetParam().test});
        int differ = 0;
        for (const Rays& rays : streams) {
            std::vector<Hit> hits(rays.size()), expected(rays.size());
            accel->closest(rays, hits);
            naive->closest(rays, expected);
            for (std::size_t i = 0; i < rays.size(); ++i)
                differ += !same_bits(hits[i], expected[i]);
        }
        EXPECT_EQ(differ, 0) << scene.name;
    }
}

} // namespace
} // namespace plumb::test
