#include "accel/sah/build_sah.h"

#include "accel/sah/binned_split.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

namespace plumb {
namespace {

bool lower_id(const PrimitiveRef& a, const PrimitiveRef& b) {
    return std::pair{a.geometry, a.primitive} < std::pair{b.geometry, b.primitive};
}

std::vector<PrimitiveRef> traceable_primitives(const GeometryView& geometry) {
    std::vector<PrimitiveRef> refs;
    refs.reserve(geometry.primitive_count());
    const auto add_all = [&](std::uint32_t id, std::size_t count) {
        for (std::uint32_t i = 0; i < count; ++i)
            if (is_traceable(geometry, id, i))
                refs.push_back({primitive_bounds(geometry, id, i), id, i});
    };
    for (std::uint32_t mesh = 0; mesh < geometry.sphere_geometry(); ++mesh)
        add_all(mesh, geometry.meshes[mesh].triangles.size());
    add_all(geometry.sphere_geometry(), geometry.spheres.size());
    return refs;
}

/// Median split by count along the longest axis of the centroids; ties by id.
std::size_t split_at_median(const PrimitiveRange& range) {
    const Vec3 extent = range.centroids.extent();
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    const std::size_t half = range.refs.size() / 2;
    std::nth_element(range.refs.begin(), range.refs.begin() + static_cast<std::ptrdiff_t>(half),
                     range.refs.end(), [&](const PrimitiveRef& a, const PrimitiveRef& b) {
                         const float ca = a.centroid()[axis], cb = b.centroid()[axis];
                         return ca < cb || (ca == cb && lower_id(a, b));
                     });
    return half;
}

template <class Predicate> std::size_t split_by(const PrimitiveRange& range, Predicate goes_left) {
    const auto middle = std::partition(range.refs.begin(), range.refs.end(), goes_left);
    return static_cast<std::size_t>(middle - range.refs.begin());
}

void set_child(SahNode& node, int i, const Bounds& bounds, ChildRef child) {
    for (int axis = 0; axis < 3; ++axis) {
        node.planes[axis][i] = bounds.lower[axis];
        node.planes[axis][2 + i] = bounds.upper[axis];
    }
    node.child[i] = child;
}

class Builder {
  public:
    Builder(const GeometryView& geometry, SahTree& tree) : geometry_(geometry), tree_(tree) {}

    void run() {
        std::vector<PrimitiveRef> refs = traceable_primitives(geometry_);
        tree_.primitive_count = refs.size();
        tree_.skipped_count = geometry_.primitive_count() - refs.size();
        tree_.sphere_geometry = geometry_.sphere_geometry();
        const PrimitiveRange all(refs);
        const ChildRef root = refs.empty() ? ChildRef::triangle_leaf(0, 0) : append(all, 0);
        if (root.is_leaf()) {
            // nodes[0] is a node always, which spares every ray a question.
            SahNode& node = tree_.nodes.emplace_back();
            set_child(node, 0, all.bounds, root);
            set_child(node, 1, Bounds{}, ChildRef::triangle_leaf(0, 0));
        }
        tree_.nodes.shrink_to_fit();
        tree_.blocks.shrink_to_fit();
        tree_.spheres.shrink_to_fit();
        const double root_area = surface_area(all.bounds);
        tree_.sah_cost = root_area > 0 ? cost_ / root_area : 0;
    }

  private:
    /// Appends the subtree of a range that is not empty.
    ChildRef append(const PrimitiveRange& range, int depth) {
        const std::size_t middle = split(range, depth);
        if (middle == 0)
            return append_leaf(range, depth);
        ++tree_.inner_count;
        cost_ += surface_area(range.bounds);
        const std::size_t index = tree_.nodes.size();
        tree_.nodes.emplace_back();
        const std::span<PrimitiveRef> halves[2]{range.refs.first(middle),
                                                range.refs.subspan(middle)};
        for (int i = 0; i < 2; ++i) {
            const PrimitiveRange half(halves[i]);
            const ChildRef child = append(half, depth + 1);
            set_child(tree_.nodes[index], i, half.bounds, child);
        }
        return ChildRef::node(static_cast<std::uint32_t>(index));
    }

    /// Orders the range so that its first part goes left; 0 where it shall be a leaf.
    std::size_t split(const PrimitiveRange& range, int depth) const {
        const std::size_t count = range.refs.size();
        if (count <= sah_max_leaf_size && is_mixed(range))
            return split_by(range, [&](const PrimitiveRef& ref) { return !is_sphere(ref); });
        if (count == 1)
            return 0;
        // Halving from here on reaches leaves, and a last split into triangles and spheres, just
        // within the bound.
        const int halvings = static_cast<int>(std::bit_width(count - 1));
        if (depth + halvings + 1 >= sah_max_depth)
            return count <= sah_max_leaf_size ? 0 : split_at_median(range);
        const auto best = best_binned_split(range);
        if (count <= sah_max_leaf_size &&
            (!best || best->cost >= leaf_cost(count) * surface_area(range.bounds)))
            return 0;
        if (!best)
            return split_at_median(range);
        return split_by(range, [&](const PrimitiveRef& ref) {
            return best->classify(ref) < best->first_right_bin;
        });
    }

    bool is_sphere(const PrimitiveRef& ref) const { return geometry_.is_sphere(ref.geometry); }
    bool is_mixed(const PrimitiveRange& range) const {
        return std::any_of(range.refs.begin(), range.refs.end(), [&](const PrimitiveRef& ref) {
            return is_sphere(ref) != is_sphere(range.refs[0]);
        });
    }

    ChildRef append_leaf(const PrimitiveRange& range, int depth) {
        const auto count = static_cast<std::uint32_t>(range.refs.size());
        ++tree_.leaf_count;
        tree_.depth = std::max(tree_.depth, depth);
        cost_ += surface_area(range.bounds) * count;
        std::sort(range.refs.begin(), range.refs.end(), lower_id);
        if (is_sphere(range.refs[0])) {
            const auto first = static_cast<std::uint32_t>(tree_.spheres.size());
            for (const PrimitiveRef& ref : range.refs)
                tree_.spheres.push_back({geometry_.spheres[ref.primitive], ref.primitive});
            return ChildRef::sphere_leaf(first, count);
        }
        const auto first = static_cast<std::uint32_t>(tree_.blocks.size());
        TriangleBlock& block = tree_.blocks.emplace_back();
        for (std::size_t lane = 0; lane < count; ++lane)
            set_lane(block, lane, range.refs[lane]);
        return ChildRef::triangle_leaf(first, count);
    }

    void set_lane(TriangleBlock& block, std::size_t lane, const PrimitiveRef& ref) const {
        const TriangleVertices t = geometry_.vertices(ref.geometry, ref.primitive);
        const Vec3 corners[3]{t.a, t.b, t.c};
        for (int i = 0; i < 3; ++i)
            for (int axis = 0; axis < 3; ++axis)
                block.vertex[i][axis][lane] = corners[i][axis];
        for (int axis = 0; axis < 3; ++axis) {
            block.bounds[0][axis][lane] = ref.bounds.lower[axis];
            block.bounds[1][axis][lane] = ref.bounds.upper[axis];
        }
        block.geometry[lane] = ref.geometry;
        block.primitive[lane] = ref.primitive;
    }

    const GeometryView& geometry_;
    SahTree& tree_;
    double cost_ = 0;
};

} // namespace

SahView SahTree::view() const {
    SahView view;
    view.nodes = nodes.data();
    view.blocks = blocks.data();
    view.spheres = spheres.data();
    view.node_count = static_cast<std::uint32_t>(nodes.size());
    view.block_count = static_cast<std::uint32_t>(blocks.size());
    view.sphere_count = static_cast<std::uint32_t>(spheres.size());
    view.sphere_geometry = sphere_geometry;
    return view;
}

SahTree build_sah(const GeometryView& geometry) {
    if (geometry.primitive_count() > std::size_t{1} << 31)
        throw std::runtime_error("sah: more than 2^31 primitives");
    SahTree tree;
    Builder(geometry, tree).run();
    return tree;
}

} // namespace plumb
