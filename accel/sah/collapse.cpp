#include "accel/sah/collapse.h"

#include "accel/sah/primitive_ref.h"
#include "accel/sah/wide_plan.h"

#include <algorithm>
#include <new>

namespace plumb {
namespace {

/// What was counted while writing.
struct Measures {
    std::size_t lanes = 0;
    double area = 0; ///< of nodes and, times their primitives, of leaves
};

/// Writes planned nodes and their leaves. Nodes are independent: one Writer a thread.
class Writer {
  public:
    Writer(const BinaryBvh& binary, const GeometryView& geometry, const WidePlan& plan,
           const WideBvh& tree, const PrimitiveNumbers& numbering)
        : binary_(binary), geometry_(geometry), plan_(plan), tree_(tree), numbering_(numbering) {
        numbers_.reserve(wide_width);
    }

    void write(const PlannedNode& planned) {
        auto& node = *new (address(planned.unit)) WideNode;
        std::uint32_t unit = planned.unit + sizeof(WideNode) / WideView::unit_bytes;
        Bounds whole;
        for (std::uint32_t i = 0; i < wide_width; ++i) {
            const bool used = i < planned.count;
            const Bounds box = used ? binary_.nodes[planned.child[i]].bounds : Bounds{};
            for (int axis = 0; axis < 3; ++axis) {
                node.planes[axis][0][i] = box.lower[axis];
                node.planes[axis][1][i] = box.upper[axis];
            }
            whole.extend(box);
            if (!used)
                node.child[i] = {};
            else if (planned.inner[i] != 0)
                node.child[i] = {plan_.nodes[planned.inner[i]].unit};
            else
                node.child[i] = write_leaf(planned.child[i], unit);
        }
        measures_.area += surface_area(whole);
    }

    [[nodiscard]] const Measures& measures() const { return measures_; }

  private:
    std::byte* address(std::uint32_t unit) const {
        return tree_.memory.data() + std::size_t{unit} * WideView::unit_bytes;
    }
    PrimitiveNumber number(std::size_t lane) const {
        return numbers_[std::min(lane, numbers_.size() - 1)];
    }

    /// Writes all that is below a binary node as a block at `unit`, which is moved past it.
    WideRef write_leaf(std::uint32_t binary_node, std::uint32_t& unit) {
        numbers_.clear();
        append_primitives(binary_, binary_node, numbers_);
        std::sort(numbers_.begin(), numbers_.end());
        numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
        measures_.lanes += numbers_.size();
        measures_.area +=
            surface_area(binary_.nodes[binary_node].bounds) * static_cast<double>(numbers_.size());
        const PrimitiveNumber first_sphere = numbering_.first_sphere();
        WideRef ref{unit | WideRef::leaf_flag};
        if (numbers_.front() >= first_sphere) {
            ref.bits |= WideRef::sphere_flag;
            auto& block = *new (address(unit)) WideSpheres;
            for (std::size_t lane = 0; lane < wide_width; ++lane) {
                block.number[lane] = number(lane);
                block.sphere[lane] = geometry_.spheres[number(lane) - first_sphere];
            }
            unit += sizeof(WideSpheres) / WideView::unit_bytes;
            return ref;
        }
        auto& block = *new (address(unit)) WideTriangles;
        for (std::size_t lane = 0; lane < wide_width; ++lane)
            write_lane(block, lane, number(lane));
        unit += sizeof(WideTriangles) / WideView::unit_bytes;
        return ref;
    }

    void write_lane(WideTriangles& block, std::size_t lane, PrimitiveNumber number) const {
        const PrimitiveNumbers::Id id = numbering_.id(number);
        const TriangleVertices t = geometry_.vertices(id.geometry, id.primitive);
        const Vec3 corners[3]{t.a, t.b, t.c};
        for (int i = 0; i < 3; ++i)
            for (int axis = 0; axis < 3; ++axis)
                block.vertex[i][axis][lane] = corners[i][axis];
        block.number[lane] = number;
    }

    const BinaryBvh& binary_;
    const GeometryView& geometry_;
    const WidePlan& plan_;
    const WideBvh& tree_;
    const PrimitiveNumbers& numbering_;
    std::vector<PrimitiveNumber> numbers_;
    Measures measures_;
};

/// Planned nodes that one task writes: fixed, so that sums come out the same for any threads.
constexpr std::size_t nodes_per_task = 1024;

} // namespace

WideView WideBvh::view() const {
    WideView view;
    view.memory = memory.data();
    view.first_of = first_of.data();
    view.geometry_count =
        static_cast<std::uint32_t>(std::max(first_of.size(), first_of_padding) - first_of_padding);
    view.reach = reach;
    view.empty = leaf_count == 0;
    view.one_level = depth == 1;
    if (view.one_level)
        for (const WideRef child : view.at<WideNode>(WideRef{}).child)
            view.one_level &= !child.has_spheres();
    view.tiny = memory.bytes() <= 16 * 1024;
    return view;
}

WideBvh collapse(const BinaryBvh& binary, const GeometryView& geometry, int threads) {
    WideBvh tree;
    const PrimitiveNumbers numbering(geometry);
    for (std::uint32_t i = 0; i <= geometry.sphere_geometry(); ++i)
        tree.first_of.push_back(numbering.first_of(i));
    tree.first_of.resize(tree.first_of.size() + first_of_padding, invalid_id);
    const WidePlan plan = plan_wide(binary, numbering.first_sphere());
    if (plan.nodes.empty())
        return tree;
    tree.memory = TreeMemory(plan.units * WideView::unit_bytes);
    tree.node_count = plan.nodes.size();
    tree.leaf_count = plan.leaf_count;
    tree.depth = plan.depth;
    const Bounds& root = binary.nodes[0].bounds;
    tree.reach = max(max_component(abs(root.lower)), max_component(abs(root.upper)));
    const std::size_t tasks = (plan.nodes.size() + nodes_per_task - 1) / nodes_per_task;
    std::vector<Measures> measures(tasks);
    parallel_for(tasks, tasks == 1 ? 1 : threads, [&](std::size_t task) {
        Writer writer(binary, geometry, plan, tree, numbering);
        const std::size_t end = std::min(plan.nodes.size(), (task + 1) * nodes_per_task);
        for (std::size_t i = task * nodes_per_task; i < end; ++i)
            writer.write(plan.nodes[i]);
        measures[task] = writer.measures();
    });
    for (const Measures& part : measures) {
        tree.lane_count += part.lanes;
        tree.sah_cost += part.area;
    }
    const double root_area = surface_area(root);
    tree.sah_cost = root_area > 0 ? tree.sah_cost / root_area : 0;
    return tree;
}

} // namespace plumb
