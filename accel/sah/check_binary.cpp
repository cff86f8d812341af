#include "accel/sah/check_binary.h"

#include "accel/sah/primitive_ref.h"
#include "accel/sah/sah_view.h"

#include <algorithm>
#include <utility>

namespace plumb {
namespace {

class Checker {
  public:
    Checker(const BinaryBvh& tree, const GeometryView& geometry)
        : tree_(tree), geometry_(geometry), numbers_(geometry) {}

    std::string run() {
        std::size_t traceable = 0;
        const auto total = static_cast<PrimitiveNumber>(geometry_.primitive_count());
        for (PrimitiveNumber n = 0; n < total; ++n)
            traceable += is_traceable(n) ? 1u : 0u;
        if (tree_.primitive_count != traceable || tree_.skipped_count != total - traceable)
            return "primitive_count or skipped_count is wrong";
        if (traceable == 0)
            return tree_.nodes.empty() && tree_.primitives.empty() ? "" : "nodes of nothing";
        if (tree_.nodes.empty())
            return "no root";
        if (std::string wrong = visit(0, 0); !wrong.empty())
            return wrong;
        if (nodes_ != tree_.nodes.size() || holders_.size() != tree_.primitives.size())
            return "a node or a place in the list is not used";
        if (depth_ != tree_.depth)
            return "depth is wrong";
        return check_primitives(traceable);
    }

  private:
    struct Holder {
        PrimitiveNumber number;
        std::uint32_t leaf;
    };

    [[nodiscard]] bool is_traceable(PrimitiveNumber number) const {
        const auto id = numbers_.id(number);
        return plumb::is_traceable(geometry_, id.geometry, id.primitive);
    }

    std::string visit(std::uint32_t index, int depth) {
        const BinaryNode& node = tree_.nodes[index];
        if (++nodes_ > tree_.nodes.size())
            return "a node is met twice";
        if (node.bounds.empty())
            return "an empty box";
        if (depth > sah_max_depth)
            return "deeper than sah_max_depth";
        if (node.is_leaf()) {
            depth_ = std::max(depth_, depth);
            return visit_leaf(index);
        }
        if (node.first <= index || node.first + std::size_t{1} >= tree_.nodes.size())
            return "a child does not come after its parent";
        Bounds both = tree_.nodes[node.first].bounds;
        both.extend(tree_.nodes[node.first + 1].bounds);
        if (!both.contains(node.bounds))
            return "a box is larger than its children need";
        for (std::uint32_t child = node.first; child < node.first + 2; ++child) {
            if (!node.bounds.contains(tree_.nodes[child].bounds))
                return "a box does not contain its child's box";
            if (std::string wrong = visit(child, depth + 1); !wrong.empty())
                return wrong;
        }
        return "";
    }

    std::string visit_leaf(std::uint32_t index) {
        const BinaryNode& leaf = tree_.nodes[index];
        if (leaf.count > sah_max_leaf_size)
            return "a leaf is larger than sah_max_leaf_size";
        if (leaf.first + std::size_t{leaf.count} > tree_.primitives.size())
            return "a leaf reaches beyond the list";
        for (std::uint32_t i = 0; i < leaf.count; ++i) {
            const PrimitiveNumber number = tree_.primitives[leaf.first + i];
            if (number >= geometry_.primitive_count())
                return "a leaf holds a number that does not exist";
            if (i > 0 && tree_.primitives[leaf.first + i - 1] >= number)
                return "the primitives of a leaf do not ascend";
            if ((number >= numbers_.first_sphere()) !=
                (tree_.primitives[leaf.first] >= numbers_.first_sphere()))
                return "a leaf holds triangles and spheres";
            holders_.push_back({number, index});
        }
        return "";
    }

    std::string check_primitives(std::size_t traceable) {
        std::sort(holders_.begin(), holders_.end(), [](const Holder& a, const Holder& b) {
            return std::pair{a.number, a.leaf} < std::pair{b.number, b.leaf};
        });
        std::size_t found = 0;
        for (auto begin = holders_.cbegin(); begin != holders_.cend(); ++found) {
            const auto end = std::find_if(
                begin, holders_.cend(), [&](const Holder& h) { return h.number != begin->number; });
            if (!is_traceable(begin->number))
                return "a leaf holds what is not traceable";
            if (std::string wrong = check_cover({begin, end}); !wrong.empty())
                return wrong;
            begin = end;
        }
        return found == traceable ? "" : "a primitive is in no leaf";
    }

    /// The leaves that hold one primitive.
    [[nodiscard]] std::string check_cover(std::span<const Holder> holders) const {
        const auto id = numbers_.id(holders[0].number);
        Bounds all;
        for (const Holder& h : holders)
            all.extend(tree_.nodes[h.leaf].bounds);
        if (!all.contains(primitive_bounds(geometry_, id.geometry, id.primitive)))
            return "the boxes of a primitive's leaves do not contain its box";
        if (holders.size() == 1)
            return "";
        if (geometry_.is_sphere(id.geometry))
            return "a sphere in two leaves";
        const TriangleVertices t = geometry_.vertices(id.geometry, id.primitive);
        constexpr int steps = 24;
        for (int i = 0; i <= steps; ++i)
            for (int j = 0; i + j <= steps; ++j) {
                const float u = static_cast<float>(i) / steps, v = static_cast<float>(j) / steps;
                const Vec3 point = t.a + u * (t.b - t.a) + v * (t.c - t.a);
                if (std::none_of(holders.begin(), holders.end(), [&](const Holder& h) {
                        return tree_.nodes[h.leaf].bounds.contains({point, point});
                    }))
                    return "a point of a triangle is in none of its leaves";
            }
        return "";
    }

    const BinaryBvh& tree_;
    const GeometryView& geometry_;
    const PrimitiveNumbers numbers_;
    std::vector<Holder> holders_;
    std::size_t nodes_ = 0;
    int depth_ = 0;
};

} // namespace

std::string check_binary(const BinaryBvh& tree, const GeometryView& geometry) {
    return Checker(tree, geometry).run();
}

} // namespace plumb
