#include "tests/support/hard_scenes.h"

#include <cmath>

namespace plumb::test {

std::vector<NamedScene> hard_scenes() {
    std::vector<NamedScene> scenes;
    Random random(121);
    const auto add = [&](const char* name, Mesh mesh) {
        scenes.push_back({name, TestGeometry(std::move(mesh))});
    };
    scenes.push_back({"nothing", TestGeometry{}});
    scenes.push_back({"mixed", mixed_scene(122)});
    add("one triangle", repeated_triangle(1));
    add("two copies", repeated_triangle(2));
    add("nine copies", repeated_triangle(9));
    add("100000 copies", repeated_triangle(100000));
    add("soup", triangle_soup(random, 20000, 0.05f));
    add("needles", needles(random, 5000, 1e-4f));
    add("plane", plane({0, 0, 0}, 10, 100));
    add("boxes at 2^i", boxes_at_powers_of_two(60));
    add("1000 nested boxes", nested_boxes(1000));
    add("displaced sphere", displaced_sphere({0, 0, 0}, 1, 160));
    TestGeometry spheres;
    for (const Sphere& s : sphere_grid(20, 0.3f))
        spheres.add(s);
    for (int i = 0; i < 1000; ++i)
        spheres.add(Sphere{{3, 3, 3}, static_cast<float>(i + 1)}); // concentric
    scenes.push_back({"spheres", std::move(spheres)});
    Mesh broken = triangle_soup(random, 100, 1);
    for (std::size_t i = 0; i < broken.positions.size(); i += 7)
        broken.positions[i].y = i % 2 == 0 ? infinity : std::nanf("");
    add("partly not traceable", std::move(broken));
    Mesh huge;
    for (int i = 0; i < 100; ++i)
        huge.add_triangle(random.point(-max_coordinate, max_coordinate),
                          random.point(-max_coordinate, max_coordinate),
                          random.point(-max_coordinate, max_coordinate));
    add("huge", std::move(huge));
    Mesh tiny = triangle_soup(random, 500, 0.1f);
    for (Vec3& p : tiny.positions)
        p = 1e-38f * p;
    add("tiny", std::move(tiny));
    // Large walls among small things: what spatial splits are for. Coordinates at which a clip
    // plane falls on vertices (Embree's pull request 489).
    Mesh walls = displaced_sphere({0, 0, 0}, 3, 24);
    for (int i = 0; i < 40; ++i)
        walls.add_triangle(random.point(-20, 20), random.point(-20, 20), random.point(-20, 20));
    add("walls", std::move(walls));
    Mesh on_planes;
    constexpr float values[]{-6.4000024f, 25.6f, 34, 57.6000022f};
    for (int i = 0; i < 300; ++i) {
        const auto corner = [&] {
            const auto pick = [&] { return values[random.index(4)]; };
            return Vec3{pick(), pick(), pick()};
        };
        on_planes.add_triangle(corner(), corner(), corner());
    }
    add("vertices on planes", std::move(on_planes));
    return scenes;
}

} // namespace plumb::test
