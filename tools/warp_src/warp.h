/// \file  A warp of a Multiprocessor: which lanes do what together.
#pragma once

#include "tools/warp_src/multiprocessor.h"

#include <algorithm>

namespace plumb::warps {

class Multiprocessor::Warp {
  public:
    Warp(Multiprocessor& owner, const WarpWork& work) : m_(owner), work_(&work) {}
    /// Takes its rays from the queue that all warps share.
    Warp(Multiprocessor& owner, std::span<const Question>& queue)
        : m_(owner), queue_(&queue), lanes_(Gpu::lanes) {}

    /// One turn of the loop. False: nothing was left to do.
    bool turn() {
        const auto working = std::ranges::count_if(lanes_, &Lane::works);
        if (queue_ != nullptr && working <= m_.kernel_.refill_at && refill())
            return true;
        if (working == 0)
            return queue_ == nullptr && next_phase();
        m_.kernel_.tree == CudaTree::binary ? binary_turn() : wide_turn();
        return true;
    }

  private:
    struct Lane {
        std::vector<Step> steps{};
        std::size_t at = 0;

        [[nodiscard]] bool works() const { return at < steps.size(); }
        [[nodiscard]] bool at_node() const { return works() && steps[at].is_node(); }
        [[nodiscard]] bool at_leaf() const { return works() && !steps[at].is_node(); }
        [[nodiscard]] const Step& step() const { return steps[at]; }
    };

    void start(Lane& lane, const Question& question) {
        lane = {steps_of(m_.trees_, m_.kernel_.tree, question), 0};
        ++m_.totals_.rays;
    }
    bool next_phase() {
        if (phase_ == work_->size())
            return false;
        const Phase& phase = (*work_)[phase_++];
        lanes_.resize(phase.lanes.size());
        for (std::size_t i = 0; i < lanes_.size(); ++i)
            start(lanes_[i], phase.lanes[i]);
        m_.issue(m_.costs_.ray, lanes_.size());
        m_.issue(phase.besides, lanes_.size());
        return true;
    }
    bool refill() {
        std::size_t started = 0;
        for (Lane& lane : lanes_)
            if (!lane.works() && !queue_->empty()) {
                start(lane, queue_->front());
                *queue_ = queue_->subspan(1);
                ++started;
            }
        if (started > 0)
            m_.issue(m_.costs_.ray, started);
        return started > 0;
    }

    /// The lanes that are at such a place.
    [[nodiscard]] std::vector<Lane*> lanes_at(bool (Lane::*place)() const) {
        std::vector<Lane*> found;
        for (Lane& lane : lanes_)
            if ((lane.*place)())
                found.push_back(&lane);
        return found;
    }

    void binary_turn() {
        const auto at_leaf = lanes_at(&Lane::at_leaf);
        test_nodes(sizeof(SahNode), m_.costs_.binary_node);
        if (m_.kernel_.loop == Loop::together)
            test_leaves(at_leaf);
        else if (std::ranges::none_of(lanes_, &Lane::at_node))
            test_leaves(lanes_at(&Lane::at_leaf));
    }
    /// Some primitives of lanes that have them left, then a node of those that have not.
    void wide_turn() {
        for (int i = 0; i < detail::primitives_a_turn; ++i)
            if (const auto at_leaf = lanes_at(&Lane::at_leaf); !at_leaf.empty())
                test_leaves(at_leaf);
        test_nodes(sizeof(CompressedNode), m_.costs_.wide_node);
    }

    void test_nodes(std::uint32_t bytes, const Cost& cost) {
        const auto lanes = lanes_at(&Lane::at_node);
        if (lanes.empty())
            return;
        from_.clear();
        for (Lane* lane : lanes) {
            from_.push_back(lane->step().address);
            ++lane->at;
        }
        m_.load(from_, bytes / 16, 16, 16);
        m_.issue(cost, lanes.size());
    }
    /// The leaves that lanes are at: first triangles of all, second ones, ...; spheres likewise.
    void test_leaves(const std::vector<Lane*>& lanes) {
        for (const StepKind kind : {StepKind::sphere, StepKind::triangle}) {
            for (std::uint32_t i = 0;; ++i) {
                from_.clear();
                for (const Lane* lane : lanes)
                    if (lane->step().kind == kind && i < lane->step().count)
                        from_.push_back(lane->step().address + i * stride_of(kind));
                if (from_.empty())
                    break;
                load_primitives(kind);
                m_.issue(kind == StepKind::sphere ? m_.costs_.sphere : m_.costs_.triangle,
                         from_.size());
            }
        }
        for (Lane* lane : lanes)
            ++lane->at;
    }
    [[nodiscard]] static std::size_t stride_of(StepKind kind) { // in leaves of the binary tree
        return kind == StepKind::sphere ? sizeof(SahSphere) : sizeof(float);
    }
    void load_primitives(StepKind kind) {
        if (m_.kernel_.tree == CudaTree::wide)
            m_.load(from_, sizeof(CompressedPrimitive) / 16, 16, 16);
        else if (kind == StepKind::sphere)
            m_.load(from_, 4, 4, 4);
        else
            m_.load(from_, 9, 4, sizeof(float) * sah_max_leaf_size);
    }

    Multiprocessor& m_;
    const WarpWork* work_ = nullptr;
    std::span<const Question>* queue_ = nullptr;
    std::size_t phase_ = 0;
    std::vector<Lane> lanes_;
    std::vector<const std::byte*> from_;
};

} // namespace plumb::warps
