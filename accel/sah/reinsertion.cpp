#include "accel/sah/reinsertion.h"

#include "accel/sah/primitive_ref.h"
#include "accel/sah/sah_cost.h"
#include "accel/sah/sah_view.h"

#include <algorithm>
#include <numeric>

namespace plumb {
namespace {

using NodeIndex = std::uint32_t;

/// A BinaryNode with its box in two registers.
struct alignas(32) Node {
    float lower[3];
    NodeIndex first;
    float upper[3];
    std::uint32_t count;

    [[nodiscard]] bool is_leaf() const { return count != 0; }
    [[nodiscard]] Box box() const { return {float4::load_xyz(lower), float4::load_xyz(upper)}; }
    void set_box(const Box& box) {
        const NodeIndex f = first;
        const std::uint32_t c = count;
        float4::store(lower, box.lower);
        float4::store(upper, box.upper);
        first = f;
        count = c;
    }
};

/// The best place for one subtree.
struct Move {
    NodeIndex from = 0, to = 0; ///< becomes the sibling of this node; 0: stays
    float gain = 0;             ///< half area of boxes saved, scaled
};

NodeIndex sibling_of(NodeIndex node) { return ((node - 1) ^ 1) + 1; } // pairs begin at 1, 3, 5...

class Optimizer {
  public:
    Optimizer(const BinaryBvh& tree, const Workers& workers)
        : workers_(workers), nodes_(tree.nodes.size()), parent_(tree.nodes.size(), 0) {
        const float extent = max_component(tree.nodes[0].bounds.extent());
        scale_ = float4::broadcast(extent > 0 && 1 / extent < infinity ? 1 / extent : 1);
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const BinaryNode& node = tree.nodes[i];
            nodes_[i].first = node.first;
            nodes_[i].count = node.count;
            nodes_[i].set_box({float4::load(node.bounds.lower), float4::load(node.bounds.upper)});
            if (!node.is_leaf())
                parent_[node.first] = parent_[node.first + 1] = static_cast<NodeIndex>(i);
        }
    }

    void run(const ReinsertionOptions& options) {
        const auto others = nodes_.size() - 1;
        const auto batch = std::min(
            others, static_cast<std::size_t>(options.fraction * static_cast<float>(others)) + 1);
        for (int i = 0; i < options.passes; ++i)
            if (!pass(batch))
                return;
    }
    [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }

  private:
    [[nodiscard]] float area(NodeIndex node) const { return nodes_[node].box().half_area(scale_); }
    [[nodiscard]] float area(const Box& box) const { return box.half_area(scale_); }

    /// Looks for moves of the `batch` largest nodes and makes those that do not meet; whether there
    /// was one.
    bool pass(std::size_t batch) {
        std::vector<Move> moves = largest(batch);
        constexpr std::size_t chunk_size = 256;
        workers_.for_each((batch + chunk_size - 1) / chunk_size, [&](std::size_t chunk) {
            std::vector<Place> stack;
            const std::size_t end = std::min(batch, (chunk + 1) * chunk_size);
            for (std::size_t i = chunk * chunk_size; i < end; ++i)
                moves[i] = best_move(moves[i].from, stack);
        });
        std::erase_if(moves, [](const Move& move) { return move.to == 0; });
        std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
            return a.gain > b.gain || (a.gain == b.gain && a.from < b.from);
        });
        std::vector<bool> touched(nodes_.size());
        for (const Move& move : moves) {
            const NodeIndex concerned[]{move.from, move.to, sibling_of(move.from),
                                        parent_[move.from], parent_[move.to]};
            if (std::any_of(std::begin(concerned), std::end(concerned),
                            [&](NodeIndex node) { return touched[node]; }))
                continue;
            for (const NodeIndex node : concerned)
                touched[node] = true;
            make(move);
        }
        return !moves.empty();
    }

    /// The nodes with the largest boxes, without the root, ties by index.
    [[nodiscard]] std::vector<Move> largest(std::size_t batch) const {
        std::vector<Move> nodes(nodes_.size() - 1);
        for (NodeIndex i = 1; i < nodes_.size(); ++i)
            nodes[i - 1] = {i, 0, area(i)};
        if (batch < nodes.size())
            std::nth_element(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(batch),
                             nodes.end(), [](const Move& a, const Move& b) {
                                 return a.gain > b.gain || (a.gain == b.gain && a.from < b.from);
                             });
        nodes.resize(batch);
        return nodes;
    }

    /// A node that may become the sibling, and what is saved before its own box grows.
    struct Place {
        NodeIndex node;
        float saved;
    };

    /// Goes up from the node; at each ancestor into the other side, as long as that can be better.
    Move best_move(NodeIndex from, std::vector<Place>& stack) const {
        Move best{from, 0, 0};
        const Box box = nodes_[from].box();
        const float own_area = area(box);
        NodeIndex pivot = parent_[from], side = sibling_of(from);
        float saved = area(pivot); // the parent goes
        Box rest;                  // of the pivot without the node
        for (;;) {
            stack.push_back({side, saved});
            while (!stack.empty()) {
                const Place place = stack.back();
                stack.pop_back();
                if (place.saved - own_area <= best.gain)
                    continue;
                const Node& node = nodes_[place.node];
                const Box own = node.box();
                Box merged = own;
                merged.extend(box);
                const float gain = place.saved - area(merged);
                if (gain > best.gain && place.node != sibling_of(from))
                    best = {from, place.node, gain};
                if (!node.is_leaf()) {
                    stack.push_back({node.first, gain + area(own)});
                    stack.push_back({node.first + 1, gain + area(own)});
                }
            }
            rest.extend(nodes_[side].box());
            if (pivot != parent_[from])
                saved += area(pivot) - area(rest);
            if (pivot == 0)
                return best;
            side = sibling_of(pivot);
            pivot = parent_[pivot];
        }
    }

    /// The pair of the node and its sibling becomes the children of `to`, whose content takes the
    /// sibling's place; the sibling takes the parent's.
    void make(const Move& move) {
        const NodeIndex sibling = sibling_of(move.from), parent = parent_[move.from];
        const Node from_parent = nodes_[sibling], from_to = nodes_[move.to];
        set_content(parent, from_parent);
        set_content(sibling, from_to);
        nodes_[move.to].first = std::min(move.from, sibling);
        nodes_[move.to].count = 0;
        parent_[move.from] = parent_[sibling] = move.to;
        refit(move.to);
        refit(parent);
    }
    void set_content(NodeIndex node, const Node& content) {
        nodes_[node] = content;
        if (!content.is_leaf())
            parent_[content.first] = parent_[content.first + 1] = node;
    }
    void refit(NodeIndex node) {
        for (;; node = parent_[node]) {
            if (!nodes_[node].is_leaf()) {
                Box box = nodes_[nodes_[node].first].box();
                box.extend(nodes_[nodes_[node].first + 1].box());
                nodes_[node].set_box(box);
            }
            if (node == 0)
                return;
        }
    }

    const Workers& workers_;
    std::vector<Node> nodes_;
    std::vector<NodeIndex> parent_;
    Float4 scale_;
};

/// Copies a tree in depth-first order and joins leaves.
class Copier {
  public:
    Copier(const std::vector<Node>& nodes, const std::vector<PrimitiveNumber>& primitives,
           PrimitiveNumber first_sphere)
        : nodes_(nodes), primitives_(primitives), first_sphere_(first_sphere) {}

    /// False where the copy would be too deep.
    bool run(BinaryBvh& to) {
        to.nodes.reserve(nodes_.size());
        to.primitives.reserve(primitives_.size());
        to.nodes.resize(1);
        return copy(0, 0, 0, to);
    }

  private:
    bool copy(NodeIndex from, std::size_t index, int depth, BinaryBvh& to) {
        if (depth > sah_max_depth)
            return false;
        to.nodes[index].bounds = nodes_[from].box().bounds();
        if (nodes_[from].is_leaf() || joins(from)) {
            const auto first = static_cast<std::uint32_t>(to.primitives.size());
            append_primitives(from, to.primitives);
            const auto list = to.primitives.begin() + first;
            std::sort(list, to.primitives.end());
            to.primitives.erase(std::unique(list, to.primitives.end()), to.primitives.end());
            to.nodes[index].first = first;
            to.nodes[index].count = static_cast<std::uint32_t>(to.primitives.size() - first);
            to.depth = std::max(to.depth, depth);
            return true;
        }
        const std::size_t children = to.nodes.size();
        to.nodes.resize(children + 2);
        to.nodes[index].first = static_cast<std::uint32_t>(children);
        return copy(nodes_[from].first, children, depth + 1, to) &&
               copy(nodes_[from].first + 1, children + 1, depth + 1, to);
    }

    /// Whether two leaves are cheaper as one.
    [[nodiscard]] bool joins(NodeIndex node) const {
        const Node& a = nodes_[nodes_[node].first];
        const Node& b = nodes_[nodes_[node].first + 1];
        if (!a.is_leaf() || !b.is_leaf() || a.count + b.count > sah_max_leaf_size ||
            (primitives_[a.first] >= first_sphere_) != (primitives_[b.first] >= first_sphere_))
            return false;
        const auto area = [](const Node& n) { return surface_area(n.box().bounds()); };
        return leaf_cost(a.count + b.count) * area(nodes_[node]) <=
               traversal_cost * area(nodes_[node]) + leaf_cost(a.count) * area(a) +
                   leaf_cost(b.count) * area(b);
    }
    void append_primitives(NodeIndex node, std::vector<PrimitiveNumber>& to) const {
        const Node& n = nodes_[node];
        if (n.is_leaf()) {
            const auto list = primitives_.begin() + n.first;
            to.insert(to.end(), list, list + n.count);
            return;
        }
        append_primitives(n.first, to);
        append_primitives(n.first + 1, to);
    }

    const std::vector<Node>& nodes_;
    const std::vector<PrimitiveNumber>& primitives_;
    PrimitiveNumber first_sphere_;
};

double total_cost(const BinaryBvh& tree) {
    return std::accumulate(
        tree.nodes.begin(), tree.nodes.end(), 0.0, [](double sum, const BinaryNode& node) {
            return sum + surface_area(node.bounds) *
                             (node.is_leaf() ? leaf_cost(node.count) : traversal_cost);
        });
}

} // namespace

void optimize_by_reinsertion(BinaryBvh& tree, const ReinsertionOptions& options,
                             PrimitiveNumber first_sphere, const Workers& workers) {
    if (tree.nodes.size() < 5) // no node has another place
        return;
    Optimizer optimizer(tree, workers);
    optimizer.run(options);
    BinaryBvh better;
    if (!Copier(optimizer.nodes(), tree.primitives, first_sphere).run(better) ||
        total_cost(better) >= total_cost(tree))
        return;
    tree.nodes = std::move(better.nodes);
    tree.primitives = std::move(better.primitives);
    tree.depth = better.depth;
}

} // namespace plumb
