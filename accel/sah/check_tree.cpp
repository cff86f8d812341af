#include "accel/sah/check_tree.h"

#include <array>
#include <vector>

namespace plumb {
namespace {

class Checker {
  public:
    Checker(const SahView& tree, const GeometryView& geometry) : tree_(tree), geometry_(geometry) {
        for (const MeshView& mesh : geometry.meshes)
            found_.emplace_back(mesh.triangles.size(), 0);
        found_.emplace_back(geometry.spheres.size(), 0);
    }

    std::string run() {
        if (tree_.node_count == 0)
            return "no root";
        if (tree_.sphere_geometry != geometry_.sphere_geometry())
            return "sphere_geometry is wrong";
        if (std::string wrong = visit_node(0, nullptr, 0); !wrong.empty())
            return wrong;
        if (nodes_ != tree_.node_count || blocks_ != tree_.block_count ||
            spheres_ != tree_.sphere_count)
            return "a node or a leaf cannot be reached";
        for (std::uint32_t g = 0; g < found_.size(); ++g)
            for (std::uint32_t p = 0; p < found_[g].size(); ++p)
                if (found_[g][p] != (is_traceable(geometry_, g, p) ? 1 : 0))
                    return "a primitive is in no leaf, in two, or in one and not traceable";
        return "";
    }

  private:
    std::string visit_node(std::uint32_t index, const Bounds* parent, int depth) {
        if (index >= tree_.node_count || ++nodes_ > tree_.node_count)
            return "a node index is out of range or met twice";
        const SahNode& node = tree_.nodes[index];
        for (int i = 0; i < 2; ++i) {
            const Bounds bounds = node.bounds(i);
            if (parent != nullptr && !parent->contains(bounds))
                return "a box does not contain its child's box";
            const ChildRef child = node.child[i];
            if (depth + 1 > sah_max_depth)
                return "deeper than sah_max_depth";
            std::string wrong = child.is_leaf() ? visit_leaf(child, bounds)
                                                : visit_node(child.first, &bounds, depth + 1);
            if (!wrong.empty())
                return wrong;
        }
        return "";
    }

    std::string visit_leaf(ChildRef leaf, const Bounds& bounds) {
        if (leaf.count() > sah_max_leaf_size)
            return "a leaf is larger than sah_max_leaf_size";
        if (leaf.count() == 0)
            return bounds.empty() ? "" : "an empty leaf has a box";
        std::string wrong;
        if (leaf.has_spheres()) {
            spheres_ += leaf.count();
            for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count() && wrong.empty(); ++i)
                wrong = i < tree_.sphere_count ? visit_sphere(tree_.spheres[i], bounds)
                                               : "a sphere index is out of range";
            return wrong;
        }
        ++blocks_;
        if (leaf.first >= tree_.block_count)
            return "a block index is out of range";
        for (std::uint32_t lane = 0; lane < leaf.count() && wrong.empty(); ++lane)
            wrong = visit_triangle(tree_.blocks[leaf.first], lane, bounds);
        return wrong;
    }

    std::string visit_sphere(const SahSphere& entry, const Bounds& bounds) {
        if (std::string wrong = count(geometry_.sphere_geometry(), entry.primitive, bounds);
            !wrong.empty())
            return wrong;
        const Sphere& original = geometry_.spheres[entry.primitive];
        const bool same =
            entry.sphere.center == original.center && entry.sphere.radius == original.radius;
        return same ? "" : "a sphere differs from its original";
    }

    std::string visit_triangle(const TriangleBlock& block, std::uint32_t lane,
                               const Bounds& bounds) {
        const std::uint32_t g = block.geometry[lane], p = block.primitive[lane];
        if (geometry_.is_sphere(g))
            return "a triangle carries the id of the spheres";
        if (std::string wrong = count(g, p, bounds); !wrong.empty())
            return wrong;
        const TriangleVertices t = geometry_.vertices(g, p);
        const bool same = block.corner(0, lane) == t.a && block.corner(1, lane) == t.b &&
                          block.corner(2, lane) == t.c;
        return same ? "" : "a triangle differs from its original";
    }

    std::string count(std::uint32_t g, std::uint32_t p, const Bounds& bounds) {
        if (g >= found_.size() || p >= found_[g].size())
            return "a leaf holds an id that does not exist";
        ++found_[g][p];
        return bounds.contains(primitive_bounds(geometry_, g, p))
                   ? ""
                   : "a leaf's box does not contain its primitive";
    }

    const SahView& tree_;
    const GeometryView& geometry_;
    std::vector<std::vector<int>> found_;
    std::uint32_t nodes_ = 0, blocks_ = 0, spheres_ = 0;
};

} // namespace

std::string check_tree(const SahView& tree, const GeometryView& geometry) {
    return Checker(tree, geometry).run();
}

} // namespace plumb
