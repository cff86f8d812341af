#include "accel/sah/wide_careful.h"

#include "accel/sah/numbered_hit.h"

namespace plumb {
namespace {

struct Entry {
    WideRef ref;
    float near;
};

/// Visits the leaves that a ray can hit, children of a node in any order, until `visit` returns
/// true. `best_t` may shrink meanwhile; it is padded, since where spatial splits cut a triangle its
/// t may lie a little before the box of the part that was hit.
template <class Visit>
bool visit_leaves(const WideView& tree, const PreparedRay& ray, const float& best_t,
                  Visit&& visit) {
    Entry stack[wide_max_stack];
    int size = 0;
    stack[size++] = {WideRef{}, ray.tmin};
    while (size > 0) {
        const Entry entry = stack[--size];
        if (entry.near > best_t * slab_padding)
            continue;
        if (entry.ref.is_leaf()) {
            if (visit(entry.ref))
                return true;
            continue;
        }
        const auto& node = tree.at<WideNode>(entry.ref);
        for (int i = 0; i < wide_width; ++i) {
            const Interval crossing = slab_interval(ray.slab, node.bounds(i));
            if (!node.bounds(i).empty() && overlaps(crossing, ray.tmin, best_t * slab_padding))
                stack[size++] = {node.child[i], crossing.near};
        }
    }
    return false;
}

bool intersect(const WideView& tree, WideRef leaf, int lane, const PreparedRay& ray,
               TriangleTest test, float tmax, PrimitiveHit& hit) {
    if (leaf.has_spheres())
        return intersect_sphere(ray, tree.at<WideSpheres>(leaf).sphere[lane], tmax, hit);
    const auto& block = tree.at<WideTriangles>(leaf);
    const Vec3 a = block.corner(0, lane), b = block.corner(1, lane), c = block.corner(2, lane);
    return test == TriangleTest::moeller_trumbore
               ? intersect_triangle<TriangleTest::moeller_trumbore>(ray, a, b, c, tmax, hit)
               : intersect_triangle<TriangleTest::watertight>(ray, a, b, c, tmax, hit);
}

} // namespace

Hit closest_careful(const WideView& tree, const Ray& ray, TriangleTest test) {
    if (tree.empty || !is_valid(ray))
        return {};
    const PreparedRay prepared(ray);
    NumberedHit best(ray.tmax);
    visit_leaves(tree, prepared, best.t, [&](WideRef leaf) {
        PrimitiveHit hit;
        for (int lane = 0; lane < wide_width; ++lane)
            if (intersect(tree, leaf, lane, prepared, test, best.t, hit))
                best.keep_closer(hit, tree.numbers(leaf)[lane]);
        return false;
    });
    return best.with_ids(tree);
}

bool occluded_careful(const WideView& tree, const Ray& ray, TriangleTest test) {
    if (tree.empty || !is_valid(ray))
        return false;
    const PreparedRay prepared(ray);
    return visit_leaves(tree, prepared, ray.tmax, [&](WideRef leaf) {
        PrimitiveHit hit;
        for (int lane = 0; lane < wide_width; ++lane)
            if (intersect(tree, leaf, lane, prepared, test, ray.tmax, hit))
                return true;
        return false;
    });
}

} // namespace plumb
