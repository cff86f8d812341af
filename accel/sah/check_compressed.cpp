#include "accel/sah/check_compressed.h"

#include "accel/math/bits.h"

#include <vector>

namespace plumb {
namespace {

class Checker {
  public:
    Checker(const CompressedView& tree, const GeometryView& geometry)
        : tree_(tree), geometry_(geometry) {
        for (const MeshView& mesh : geometry.meshes)
            found_.emplace_back(mesh.triangles.size(), 0);
        found_.emplace_back(geometry.spheres.size(), 0);
    }

    std::string run() {
        if (tree_.node_count == 0)
            return "no root";
        Bounds all;
        if (std::string wrong = visit_node(0, 0, all); !wrong.empty())
            return wrong;
        if (nodes_ != tree_.node_count || primitives_ != tree_.primitive_count)
            return "a node or a primitive cannot be reached";
        if (!all.empty() &&
            max(max_component(abs(all.lower)), max_component(abs(all.upper))) > tree_.reach)
            return "reach is too small";
        for (std::uint32_t g = 0; g < found_.size(); ++g)
            for (std::uint32_t p = 0; p < found_[g].size(); ++p)
                if (found_[g][p] != (is_traceable(geometry_, g, p) ? 1 : 0))
                    return "a primitive is in no leaf, in two, or in one and not traceable";
        return "";
    }

  private:
    /// `below`: is extended by all primitives of the subtree.
    std::string visit_node(std::uint32_t index, int depth, Bounds& below) {
        if (index >= tree_.node_count || ++nodes_ > tree_.node_count)
            return "a node index is out of range or met twice";
        if (depth >= compressed_max_depth)
            return "deeper than compressed_max_depth";
        const CompressedNode& node = tree_.nodes[index];
        std::uint32_t child = node.first_child, leaf_bits = 0;
        for (std::uint32_t slot = 0; slot < compressed_width; ++slot) {
            const std::uint32_t meta = CompressedNode::byte(node.meta, slot);
            const bool inner = (node.inner_mask() >> slot & 1u) != 0;
            if (inner != (meta == (1u << 5 | (24 + slot))))
                return "inner_mask and meta contradict each other";
            if (meta == 0)
                continue;
            Bounds box;
            std::string wrong = inner ? visit_node(child++, depth + 1, box)
                                      : visit_leaf(node, meta, leaf_bits, box);
            if (!wrong.empty())
                return wrong;
            if (!node.bounds(slot).contains(box))
                return "a decoded box does not contain what is below it";
            below.extend(box);
        }
        return "";
    }

    std::string visit_leaf(const CompressedNode& node, std::uint32_t meta, std::uint32_t& taken,
                           Bounds& below) {
        const std::uint32_t count = ones(meta >> 5), first = meta & 31u;
        if (count > compressed_max_leaf || meta >> 5 != (1u << count) - 1 || first + count > 24)
            return "a leaf's count is not written as ones";
        const std::uint32_t bits = ((1u << count) - 1) << first;
        if ((taken & bits) != 0)
            return "two leaves share a primitive";
        taken |= bits;
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t index = node.first_primitive + first + i;
            if (index >= tree_.primitive_count)
                return "a primitive index is out of range";
            if (std::string wrong = visit_primitive(tree_.primitives[index]); !wrong.empty())
                return wrong;
            const CompressedPrimitive& p = tree_.primitives[index];
            below.extend(primitive_bounds(geometry_, p.geometry, p.primitive));
        }
        return "";
    }

    std::string visit_primitive(const CompressedPrimitive& p) {
        ++primitives_;
        if (p.geometry >= found_.size() || p.primitive >= found_[p.geometry].size())
            return "a leaf holds an id that does not exist";
        ++found_[p.geometry][p.primitive];
        const bool sphere = geometry_.is_sphere(p.geometry);
        if (sphere != (p.is_sphere != 0))
            return "a primitive is of the wrong kind";
        if (sphere) {
            const Sphere& s = geometry_.spheres[p.primitive];
            return s.center == p.a && s.radius == p.b.x ? "" : "a sphere differs from its original";
        }
        const TriangleVertices t = geometry_.vertices(p.geometry, p.primitive);
        return t.a == p.a && t.b == p.b && t.c == p.c ? "" : "a triangle differs from its original";
    }

    const CompressedView& tree_;
    const GeometryView& geometry_;
    std::vector<std::vector<int>> found_;
    std::uint32_t nodes_ = 0, primitives_ = 0;
};

} // namespace

std::string check_compressed(const CompressedView& tree, const GeometryView& geometry) {
    return Checker(tree, geometry).run();
}

} // namespace plumb
