#include "accel/sah/wide_plan.h"

#include <algorithm>
#include <stdexcept>

namespace plumb {
namespace {

constexpr std::uint32_t node_units = sizeof(WideNode) / WideView::unit_bytes;
constexpr std::uint32_t triangle_units = sizeof(WideTriangles) / WideView::unit_bytes;
constexpr std::uint32_t sphere_units = sizeof(WideSpheres) / WideView::unit_bytes;

/// What a binary subtree costs as a forest of at most 1, 2, ... 7 wide children.
struct Choice {
    float cost[wide_width]; ///< [i]: as at most i children; [0] is not used
    /// [i]: how many of i children the left half gets; 0: fewer than i are as good. [8]: of the
    /// node's own children, if it becomes a wide node.
    std::uint8_t left[wide_width + 1];
    std::uint8_t leaf_size; ///< primitives below, 255 for too many or mixed
    bool as_leaf;           ///< cheaper as one leaf than as a node
    bool spheres;
};

class Planner {
  public:
    Planner(const BinaryBvh& tree, PrimitiveNumber first_sphere, const WideCosts& costs)
        : tree_(tree), first_sphere_(first_sphere), costs_(costs), choices_(tree.nodes.size()) {
        const double root_area = surface_area(tree.nodes[0].bounds);
        per_area_ = root_area > 0 ? 1 / root_area : 1;
    }

    WidePlan run() {
        choose(0);
        plan_.nodes.reserve(tree_.nodes.size() / 8 + 1);
        if (tree_.nodes[0].is_leaf() || choices_[0].as_leaf) {
            PlannedNode& root = plan_.nodes.emplace_back();
            root.child[root.count++] = 0;
            place(0, 0);
        } else {
            append(0, 0);
        }
        return std::move(plan_);
    }

  private:
    /// Fills in the choices of a subtree, children first.
    void choose(std::uint32_t index) {
        const BinaryNode& node = tree_.nodes[index];
        Choice& choice = choices_[index];
        const double area = surface_area(node.bounds) * per_area_;
        if (node.is_leaf()) {
            const auto cost = static_cast<float>(area * leaf_cost(node.count));
            std::fill(std::begin(choice.cost), std::end(choice.cost), cost);
            std::fill(std::begin(choice.left), std::end(choice.left), std::uint8_t{0});
            choice.leaf_size = static_cast<std::uint8_t>(node.count);
            choice.as_leaf = true;
            choice.spheres = is_sphere_leaf(tree_, node, first_sphere_);
            return;
        }
        choose(node.first);
        choose(node.first + 1);
        const Choice& left = choices_[node.first];
        const Choice& right = choices_[node.first + 1];
        float best[wide_width + 1];
        for (int i = 2; i <= wide_width; ++i) {
            best[i] = std::numeric_limits<float>::infinity();
            for (int k = std::max(1, i - 7); k < i && k < wide_width; ++k) {
                const float cost = left.cost[k] + right.cost[i - k];
                if (cost < best[i]) {
                    best[i] = cost;
                    choice.left[i] = static_cast<std::uint8_t>(k);
                }
            }
        }
        const bool fits =
            static_cast<std::uint32_t>(left.leaf_size + right.leaf_size) <= costs_.max_leaf &&
            left.spheres == right.spheres && left.leaf_size != 255;
        choice.leaf_size =
            fits ? static_cast<std::uint8_t>(left.leaf_size + right.leaf_size) : std::uint8_t{255};
        choice.spheres = left.spheres;
        const auto inner = static_cast<float>(area) + best[wide_width];
        const auto leaf = fits ? static_cast<float>(area * leaf_cost(choice.leaf_size))
                               : std::numeric_limits<float>::infinity();
        choice.as_leaf = leaf <= inner;
        choice.cost[1] = std::min(leaf, inner);
        for (int i = 2; i < wide_width; ++i) {
            if (best[i] < choice.cost[i - 1]) {
                choice.cost[i] = best[i];
            } else {
                choice.cost[i] = choice.cost[i - 1];
                choice.left[i] = 0;
            }
        }
    }

    [[nodiscard]] double leaf_cost(std::uint32_t count) const {
        return costs_.leaf + costs_.primitive * count;
    }

    /// Adds the roots of the forest of at most `slots` children that a subtree was to become.
    void gather(std::uint32_t index, int slots, PlannedNode& into) const {
        const Choice& choice = choices_[index];
        while (slots > 1 && choice.left[slots] == 0)
            --slots;
        if (slots == 1) {
            into.child[into.count++] = index;
            return;
        }
        const std::uint32_t left = tree_.nodes[index].first;
        gather(left, choice.left[slots], into);
        gather(left + 1, slots - choice.left[slots], into);
    }

    /// Plans the wide node of a binary node and all below. Returns its index.
    std::uint32_t append(std::uint32_t index, int depth) {
        PlannedNode node;
        const std::uint32_t left = tree_.nodes[index].first;
        const int left_slots = choices_[index].left[wide_width];
        gather(left, left_slots, node);
        gather(left + 1, wide_width - left_slots, node);
        const auto planned = static_cast<std::uint32_t>(plan_.nodes.size());
        plan_.nodes.push_back(node);
        place(planned, depth);
        return planned;
    }

    /// Gives a planned node and its leaves their place, then plans its inner children.
    void place(std::uint32_t planned, int depth) {
        PlannedNode node = plan_.nodes[planned];
        node.unit = static_cast<std::uint32_t>(plan_.units);
        plan_.units += node_units;
        for (std::uint32_t i = 0; i < node.count; ++i) {
            const Choice& choice = choices_[node.child[i]];
            node.inner[i] = 0;
            if (choice.as_leaf) {
                plan_.units += choice.spheres ? sphere_units : triangle_units;
                ++plan_.leaf_count;
                plan_.depth = std::max(plan_.depth, depth + 1);
            }
        }
        if (plan_.units > WideRef::max_unit)
            throw std::runtime_error("sah: the tree would take more than 64 GB");
        for (std::uint32_t i = 0; i < node.count; ++i)
            if (!choices_[node.child[i]].as_leaf)
                node.inner[i] = append(node.child[i], depth + 1);
        plan_.nodes[planned] = node;
    }

    const BinaryBvh& tree_;
    PrimitiveNumber first_sphere_;
    const WideCosts& costs_;
    std::vector<Choice> choices_;
    double per_area_ = 1;
    WidePlan plan_;
};

} // namespace

void append_primitives(const BinaryBvh& tree, std::uint32_t node,
                       std::vector<PrimitiveNumber>& numbers) {
    const BinaryNode& n = tree.nodes[node];
    if (n.is_leaf()) {
        const auto first = tree.primitives.begin() + n.first;
        numbers.insert(numbers.end(), first, first + n.count);
        return;
    }
    append_primitives(tree, n.first, numbers);
    append_primitives(tree, n.first + 1, numbers);
}

WidePlan plan_wide(const BinaryBvh& tree, PrimitiveNumber first_sphere, const WideCosts& costs) {
    return tree.nodes.empty() ? WidePlan{} : Planner(tree, first_sphere, costs).run();
}

} // namespace plumb
