/// \file  Axes of the builders: scenes that make trees deep.
#include "accel/intersector.h"
#include "accel/naive/build_naive.h"
#include "accel/sah/build_binary.h"
#include "tools/stability_src/alternatives/median_by_position.h"
#include "tools/stability_src/axis.h"
#include "tools/stability_src/mesh.h"

namespace plumb::stability {
namespace {

void add_box(Mesh& mesh, Vec3 lower, Vec3 upper) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const std::uint32_t corner : {0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u})
        mesh.positions.push_back({(corner & 1u) != 0 ? upper.x : lower.x,
                                  (corner & 2u) != 0 ? upper.y : lower.y,
                                  (corner & 4u) != 0 ? upper.z : lower.z});
    constexpr std::uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& q : quads) {
        mesh.triangles.push_back({first + q[0], first + q[1], first + q[2]});
        mesh.triangles.push_back({first + q[0], first + q[2], first + q[3]});
    }
}

/// Lower corners at 2^i, edges of 2^(i-2); i around 0.
Mesh boxes_at_powers(double count) {
    Mesh mesh;
    const int n = static_cast<int>(count);
    for (int i = -n / 2; i < n - n / 2; ++i) {
        const float low = std::ldexp(1.0f, i), high = 1.25f * low;
        add_box(mesh, {low, low, low}, {high, high, high});
    }
    return mesh;
}

/// Each 4 % larger than the one inside it.
Mesh nested_boxes(double count) {
    Mesh mesh;
    for (int i = 0; i < static_cast<int>(count); ++i) {
        const auto h = static_cast<float>(std::pow(1.04, i));
        add_box(mesh, {-h, -h, -h}, {h, h, h});
    }
    return mesh;
}

std::vector<Outcome> depths(const Mesh& mesh) {
    const MeshView view = mesh.view();
    const GeometryView geometry{{&view, 1}, {}};
    std::vector<Vec3> centroids;
    for (const Triangle t : mesh.triangles)
        centroids.push_back(
            vertex_bounds(mesh.positions[t.a], mesh.positions[t.b], mesh.positions[t.c]).center());
    const auto wide = [&](BuildQuality quality) {
        BuildOptions options;
        options.quality = quality;
        options.threads = 1;
        return make_intersector(AccelKind::sah, geometry, options)->stats().depth;
    };
    std::vector<Outcome> outcomes;
    for (const int depth :
         {depth_by_position(centroids), make_intersector(AccelKind::naive, geometry)->stats().depth,
          build_binary(geometry, {BuildQuality::medium, 1}).depth, wide(BuildQuality::medium),
          wide(BuildQuality::high)})
        outcomes.push_back({mesh.triangles.size(), 0, static_cast<double>(depth)});
    return outcomes;
}

Axis tree_axis(std::string name, std::string title, std::string unit, Mesh (*make)(double)) {
    Axis axis;
    axis.name = std::move(name);
    axis.group = "trees";
    axis.title = std::move(title);
    axis.unit = std::move(unit);
    axis.failure = "value: depth of the deepest leaf; stacks of traversals are sized for 64";
    axis.range = "at most 64 for any scene";
    axis.value = "depth";
    axis.trials = axis.quick_trials = 1;
    axis.methods = {{"median-by-position", "split in the middle of space"},
                    {"naive", "split in the middle of the count, the plain tree", false, 64.0},
                    {"sah-binary", "the binary SAH tree of the device", true, 64.0},
                    {"sah-wide", "the 8-wide SAH tree", true, 64.0},
                    {"sah-wide-high", "the same with spatial splits", false, 64.0}};
    axis.run = [make](const Trial& trial) { return depths(make(trial.stress)); };
    return axis;
}

} // namespace

void add_tree_axes(std::vector<Axis>& axes) {
    axes.push_back(tree_axis("tree-powers", "Boxes at powers of two", "boxes of 12 triangles",
                             boxes_at_powers));
    axes.back().tested = "boxes with corners at 2^i and edges of 2^(i-2)";
    axes.back().stresses = {2, 4, 8, 16, 32, 64, 120};
    axes.push_back(tree_axis("tree-nested", "Nested boxes", "boxes of 12 triangles", nested_boxes));
    axes.back().tested = "boxes around one point, each 4 % larger than the one inside it";
    axes.back().stresses = {1, 3, 10, 30, 100, 300, 1000};
}

} // namespace plumb::stability
