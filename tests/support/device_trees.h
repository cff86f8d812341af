/// \file  The trees that a device reads, as Intersectors on the host.
#pragma once

#include "accel/intersector.h"
#include "accel/sah/build_compressed.h"
#include "accel/sah/build_sah.h"
#include "accel/sah/compressed_traverse.h"

namespace plumb::test {

/// `Tree`: SahTree or CompressedTree.
template <class Tree> class DeviceTreeIntersector final : public Intersector {
  public:
    DeviceTreeIntersector(Tree tree, TriangleTest test) : tree_(std::move(tree)), test_(test) {}
    using Intersector::closest;
    using Intersector::occluded;

    [[nodiscard]] Hit closest(const Ray& ray) const override {
        return test_ == TriangleTest::watertight
                   ? plumb::closest<TriangleTest::watertight>(tree_.view(), ray)
                   : plumb::closest<TriangleTest::moeller_trumbore>(tree_.view(), ray);
    }
    [[nodiscard]] bool occluded(const Ray& ray) const override {
        return test_ == TriangleTest::watertight
                   ? plumb::occluded<TriangleTest::watertight>(tree_.view(), ray)
                   : plumb::occluded<TriangleTest::moeller_trumbore>(tree_.view(), ray);
    }
    [[nodiscard]] AccelStats stats() const override { return tree_.stats(); }
    [[nodiscard]] const Tree& tree() const { return tree_; }

  private:
    Tree tree_;
    TriangleTest test_;
};

using BinaryOnHost = DeviceTreeIntersector<SahTree>;
using CompressedOnHost = DeviceTreeIntersector<CompressedTree>;

} // namespace plumb::test
