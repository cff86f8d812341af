#include "tools/warp_src/steps.h"

namespace plumb::warps {
namespace {

template <class T> const std::byte* address_of(const T* array, std::uint32_t index) {
    return reinterpret_cast<const std::byte*>(array + index);
}

struct BinaryListener {
    const SahView& view;
    std::vector<Step>& steps;

    void node(std::uint32_t index) {
        steps.push_back({address_of(view.nodes, index), StepKind::node, 1});
    }
    void leaf(ChildRef leaf) {
        if (leaf.has_spheres())
            steps.push_back({address_of(view.spheres, leaf.first), StepKind::sphere, leaf.count()});
        else
            steps.push_back(
                {address_of(view.blocks, leaf.first), StepKind::triangle, leaf.count()});
    }
};

struct WideListener {
    const CompressedView& view;
    std::vector<Step>& steps;

    void node(std::uint32_t index) {
        steps.push_back({address_of(view.nodes, index), StepKind::node, 1});
    }
    void primitive(std::uint32_t index) {
        const bool is_sphere = view.primitives[index].is_sphere != 0;
        steps.push_back({address_of(view.primitives, index),
                         is_sphere ? StepKind::sphere : StepKind::triangle, 1});
    }
};

template <class View, class Listener>
void trace(const View& view, const Question& question, Listener&& listener) {
    constexpr TriangleTest test = TriangleTest::watertight;
    if (question.any_hit)
        static_cast<void>(occluded<test>(view, question.ray, listener));
    else
        static_cast<void>(closest<test>(view, question.ray, listener));
}

} // namespace

std::vector<Step> steps_of(const TreeViews& trees, CudaTree tree, const Question& question) {
    std::vector<Step> steps;
    if (tree == CudaTree::binary)
        trace(trees.binary, question, BinaryListener{trees.binary, steps});
    else
        trace(trees.wide, question, WideListener{trees.wide, steps});
    return steps;
}

} // namespace plumb::warps
