#include "accel/sah/check_wide.h"

#include "accel/sah/primitive_ref.h"

#include <algorithm>

namespace plumb {
namespace {

class Checker {
  public:
    Checker(const WideBvh& tree, const GeometryView& geometry)
        : tree_(tree), view_(tree.view()), geometry_(geometry), numbering_(geometry),
          unit_used_(tree.memory.bytes() / WideView::unit_bytes, false),
          leaves_(geometry.primitive_count()), covered_(geometry.primitive_count()) {}

    std::string run(bool spatial_splits) {
        if (std::string wrong = check_tables(); !wrong.empty())
            return wrong;
        if (!view_.empty)
            if (std::string wrong = visit_node(WideRef{}, Bounds{}, 0); !wrong.empty())
                return wrong;
        if (std::find(unit_used_.begin(), unit_used_.end(), false) != unit_used_.end())
            return "a unit of the memory is not used";
        if (nodes_ != tree_.node_count || blocks_ != tree_.leaf_count ||
            lanes_ != tree_.lane_count || depth_ != tree_.depth)
            return "nodes, leaves, lanes or the depth are counted wrongly";
        return check_primitives(spatial_splits);
    }

  private:
    std::string check_tables() const {
        if (view_.geometry_count != geometry_.meshes.size() + 1)
            return "geometry_count is wrong";
        for (std::uint32_t g = 0; g < view_.geometry_count; ++g)
            if (view_.first_of[g] != numbering_.first_of(g))
                return "first_of is wrong";
        for (std::size_t i = 0; i < first_of_padding; ++i)
            if (view_.first_of[view_.geometry_count + i] != invalid_id)
                return "first_of is not padded";
        if (view_.one_level != has_one_level())
            return "one_level is wrong";
        return tree_.memory.bytes() % WideView::unit_bytes == 0 ? "" : "the memory is no units";
    }

    /// Whether all children of the root are blocks of triangles.
    bool has_one_level() const {
        if (view_.empty)
            return false;
        const auto& root = view_.at<WideNode>(WideRef{});
        bool one_level = true;
        for (int i = 0; i < wide_width && !root.bounds(i).empty(); ++i)
            one_level &= root.child[i].is_leaf() && !root.child[i].has_spheres();
        return one_level;
    }

    std::string check_primitives(bool spatial_splits) const {
        for (PrimitiveNumber i = 0; i < leaves_.size(); ++i) {
            const PrimitiveNumbers::Id id = numbering_.id(i);
            if (!is_traceable(geometry_, id.geometry, id.primitive)) {
                if (leaves_[i] != 0)
                    return "a primitive that is not traceable is in a leaf";
                continue;
            }
            if (leaves_[i] == 0 || (leaves_[i] > 1 && !spatial_splits))
                return "a primitive is in no leaf or in two";
            if (!covered_[i].contains(primitive_bounds(geometry_, id.geometry, id.primitive)))
                return "the leaves' boxes do not contain a primitive";
        }
        return "";
    }

    /// Takes the units of a node or block; false where they are out of range or taken.
    bool take_units(WideRef ref, std::size_t bytes) {
        const std::size_t first = ref.unit(), end = first + bytes / WideView::unit_bytes;
        if (end > unit_used_.size())
            return false;
        for (std::size_t i = first; i < end; ++i) {
            if (unit_used_[i])
                return false;
            unit_used_[i] = true;
        }
        return true;
    }

    /// `box`: what the parent says of it; empty for the root.
    std::string visit_node(WideRef ref, const Bounds& box, int depth) {
        if (depth >= wide_max_depth)
            return "deeper than wide_max_depth";
        if (!take_units(ref, sizeof(WideNode)))
            return "a node lies outside the memory or on something else";
        ++nodes_;
        const auto& node = view_.at<WideNode>(ref);
        bool ended = false;
        for (int i = 0; i < wide_width; ++i) {
            const Bounds child = node.bounds(i);
            if (child.empty()) {
                ended = true;
                if (child.lower != Bounds{}.lower || child.upper != Bounds{}.upper)
                    return "a child that is not there has a box";
                continue;
            }
            if (ended)
                return "a child stands behind one that is not there";
            if (depth > 0 && !box.contains(child))
                return "a box does not contain a box below";
            if (max(max_component(abs(child.lower)), max_component(abs(child.upper))) > view_.reach)
                return "reach is too small";
            if (std::string wrong = node.child[i].is_leaf()
                                        ? visit_leaf(node.child[i], child, depth + 1)
                                        : visit_node(node.child[i], child, depth + 1);
                !wrong.empty())
                return wrong;
        }
        return node.bounds(0).empty() ? "a node without children" : "";
    }

    std::string visit_leaf(WideRef ref, const Bounds& box, int depth) {
        if (!take_units(ref, ref.has_spheres() ? sizeof(WideSpheres) : sizeof(WideTriangles)))
            return "a leaf lies outside the memory or on something else";
        ++blocks_;
        depth_ = std::max(depth_, depth);
        const PrimitiveNumber* number = view_.numbers(ref);
        bool ended = false;
        for (int lane = 0; lane < wide_width; ++lane) {
            const bool repeats = lane > 0 && number[lane] == number[lane - 1];
            if (number[lane] >= leaves_.size())
                return "a leaf holds a number that does not exist";
            if (lane > 0 && (number[lane] < number[lane - 1] || (ended && !repeats)))
                return "a leaf's numbers do not ascend";
            ended = ended || repeats;
            if (!is_original(ref, lane, number[lane]))
                return "a primitive differs from its original";
            if (repeats)
                continue;
            ++lanes_;
            ++leaves_[number[lane]];
            covered_[number[lane]].extend(box);
        }
        return "";
    }

    [[nodiscard]] bool is_original(WideRef leaf, int lane, PrimitiveNumber number) const {
        const PrimitiveNumbers::Id id = numbering_.id(number);
        if (geometry_.is_sphere(id.geometry) != leaf.has_spheres())
            return false;
        if (leaf.has_spheres()) {
            const Sphere& here = view_.at<WideSpheres>(leaf).sphere[lane];
            const Sphere& there = geometry_.spheres[id.primitive];
            return here.center == there.center && here.radius == there.radius;
        }
        const auto& block = view_.at<WideTriangles>(leaf);
        const TriangleVertices t = geometry_.vertices(id.geometry, id.primitive);
        return block.corner(0, lane) == t.a && block.corner(1, lane) == t.b &&
               block.corner(2, lane) == t.c;
    }

    const WideBvh& tree_;
    const WideView view_;
    const GeometryView& geometry_;
    const PrimitiveNumbers numbering_;
    std::vector<bool> unit_used_;
    std::vector<std::uint32_t> leaves_; ///< in which each primitive is
    std::vector<Bounds> covered_;       ///< the boxes of those together
    std::size_t nodes_ = 0, blocks_ = 0, lanes_ = 0;
    int depth_ = 0;
};

} // namespace

std::string check_wide(const WideBvh& tree, const GeometryView& geometry, bool spatial_splits) {
    return Checker(tree, geometry).run(spatial_splits);
}

} // namespace plumb
