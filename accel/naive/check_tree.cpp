#include "accel/naive/check_tree.h"

#include <bit>
#include <set>
#include <utility>

namespace plumb {
namespace {

class Checker {
  public:
    Checker(const NaiveTree& tree, const GeometryView& geometry)
        : tree_(tree), geometry_(geometry) {}

    std::string run() {
        std::size_t traceable = 0;
        for (std::uint32_t g = 0; g <= geometry_.sphere_geometry(); ++g)
            for (std::uint32_t p = 0; p < count_of(g); ++p)
                traceable += is_traceable(geometry_, g, p) ? 1u : 0u;
        if (traceable + tree_.skipped_count != geometry_.primitive_count())
            return "skipped_count is wrong";
        if (traceable == 0)
            return tree_.nodes.empty() ? "" : "nodes without primitives";
        if (tree_.nodes.size() != 2 * traceable - 1)
            return "the node count is not 2n - 1";
        depth_limit_ = static_cast<int>(std::bit_width(traceable - 1));
        std::string wrong = visit(0, 0);
        if (wrong.empty() && found_.size() != traceable)
            wrong = "a traceable primitive is in no leaf";
        return wrong;
    }

  private:
    std::size_t count_of(std::uint32_t g) const {
        return geometry_.is_sphere(g) ? geometry_.spheres.size()
                                      : geometry_.meshes[g].triangles.size();
    }

    std::string visit(std::uint32_t index, int depth) {
        if (index >= tree_.nodes.size())
            return "a child index is out of range";
        if (depth > depth_limit_)
            return "a leaf is deeper than ceil(log2 n)";
        const NaiveNode& node = tree_.nodes[index];
        if (node.is_leaf())
            return visit_leaf(node);
        for (const std::uint32_t child : {node.left, node.right}) {
            if (child <= index || child >= tree_.nodes.size())
                return "a child does not come after its parent";
            if (!node.bounds.contains(tree_.nodes[child].bounds))
                return "a box does not contain its child's box";
            if (std::string wrong = visit(child, depth + 1); !wrong.empty())
                return wrong;
        }
        return "";
    }

    std::string visit_leaf(const NaiveNode& leaf) {
        if (leaf.geometry > geometry_.sphere_geometry() ||
            leaf.primitive >= count_of(leaf.geometry))
            return "a leaf holds an id that does not exist";
        if (!is_traceable(geometry_, leaf.geometry, leaf.primitive))
            return "a leaf holds a primitive that is not traceable";
        if (!leaf.bounds.contains(primitive_bounds(geometry_, leaf.geometry, leaf.primitive)))
            return "a leaf's box does not contain its primitive";
        if (!found_.insert({leaf.geometry, leaf.primitive}).second)
            return "a primitive is in two leaves";
        return "";
    }

    const NaiveTree& tree_;
    const GeometryView& geometry_;
    std::set<std::pair<std::uint32_t, std::uint32_t>> found_;
    int depth_limit_ = 0;
};

} // namespace

std::string check_tree(const NaiveTree& tree, const GeometryView& geometry) {
    return Checker(tree, geometry).run();
}

} // namespace plumb
