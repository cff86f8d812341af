#include "accel/naive/naive_intersector.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace plumb {
namespace {

/// Depth of the deepest leaf below a node, and the sum of areas times costs (C_t = C_i = 1).
struct Measures {
    int depth;
    double area;
};

Measures measure(const std::vector<NaiveNode>& nodes, const NaiveNode& node) {
    if (node.is_leaf())
        return {0, surface_area(node.bounds)};
    const Measures left = measure(nodes, nodes[node.left]);
    const Measures right = measure(nodes, nodes[node.right]);
    return {1 + std::max(left.depth, right.depth),
            surface_area(node.bounds) + left.area + right.area};
}

} // namespace

NaiveIntersector::NaiveIntersector(GeometryView geometry, TriangleTest test)
    : geometry_(geometry), test_(test) {
    const auto start = std::chrono::steady_clock::now();
    tree_ = build_naive(geometry_);
    build_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

bool NaiveIntersector::intersect(const NaiveNode& leaf, const PreparedRay& ray, float tmax,
                                 PrimitiveHit& hit) const {
    if (geometry_.is_sphere(leaf.geometry))
        return intersect_sphere(ray, geometry_.spheres[leaf.primitive], tmax, hit);
    const TriangleVertices v = geometry_.vertices(leaf.geometry, leaf.primitive);
    if (test_ == TriangleTest::moeller_trumbore)
        return intersect_triangle<TriangleTest::moeller_trumbore>(ray, v.a, v.b, v.c, tmax, hit);
    return intersect_triangle<TriangleTest::watertight>(ray, v.a, v.b, v.c, tmax, hit);
}

// A box is entered while it can hold a hit at or before the best one: at an equal t the lower id
// still wins, so equality must not be pruned.
void NaiveIntersector::find_closest(const NaiveNode& node, const PreparedRay& ray,
                                    Hit& best) const {
    if (!overlaps(slab_interval(ray.slab, node.bounds), ray.tmin, best.t))
        return;
    if (!node.is_leaf()) {
        find_closest(tree_.nodes[node.left], ray, best);
        find_closest(tree_.nodes[node.right], ray, best);
        return;
    }
    PrimitiveHit hit;
    if (!intersect(node, ray, best.t, hit))
        return;
    const std::pair id{node.geometry, node.primitive};
    if (hit.t < best.t || id < std::pair{best.geometry, best.primitive})
        best = {hit.t, hit.u, hit.v, node.geometry, node.primitive, invalid_id};
}

bool NaiveIntersector::find_any(const NaiveNode& node, const PreparedRay& ray) const {
    if (!overlaps(slab_interval(ray.slab, node.bounds), ray.tmin, ray.tmax))
        return false;
    if (!node.is_leaf())
        return find_any(tree_.nodes[node.left], ray) || find_any(tree_.nodes[node.right], ray);
    PrimitiveHit hit;
    return intersect(node, ray, ray.tmax, hit);
}

Hit NaiveIntersector::closest(const Ray& ray) const {
    if (tree_.nodes.empty() || !is_valid(ray))
        return {};
    Hit best;
    best.t = ray.tmax;
    find_closest(tree_.nodes[0], PreparedRay(ray), best);
    return best.valid() ? best : Hit{};
}

bool NaiveIntersector::occluded(const Ray& ray) const {
    return !tree_.nodes.empty() && is_valid(ray) && find_any(tree_.nodes[0], PreparedRay(ray));
}

AccelStats NaiveIntersector::stats() const {
    AccelStats stats;
    stats.build_s = build_s_;
    stats.bytes = tree_.nodes.size() * sizeof(NaiveNode);
    stats.node_count = tree_.nodes.size();
    stats.leaf_count = stats.primitive_count = (tree_.nodes.size() + 1) / 2;
    stats.skipped_count = tree_.skipped_count;
    if (tree_.nodes.empty())
        return stats;
    const Measures measures = measure(tree_.nodes, tree_.nodes[0]);
    const double root_area = surface_area(tree_.nodes[0].bounds);
    stats.depth = measures.depth;
    stats.sah_cost = root_area > 0 ? measures.area / root_area : 0;
    return stats;
}

} // namespace plumb
