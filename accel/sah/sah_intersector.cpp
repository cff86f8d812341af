#include "accel/sah/sah_intersector.h"

#include "accel/sah/sah_traverse.h"

#include <chrono>

namespace plumb {
namespace {

template <TriangleTest Test> class SahIntersectorWith final : public SahIntersector {
  public:
    explicit SahIntersectorWith(const GeometryView& geometry) : SahIntersector(geometry) {}

    using Intersector::closest;
    using Intersector::occluded;
    [[nodiscard]] Hit closest(const Ray& ray) const override {
        return plumb::closest<Test>(view(), ray);
    }
    [[nodiscard]] bool occluded(const Ray& ray) const override {
        return plumb::occluded<Test>(view(), ray);
    }
    void closest(std::span<const Ray> rays, std::span<Hit> hits) const override {
        for (std::size_t i = 0; i < rays.size(); ++i)
            hits[i] = plumb::closest<Test>(view(), rays[i]);
    }
};

} // namespace

SahIntersector::SahIntersector(const GeometryView& geometry) {
    const auto start = std::chrono::steady_clock::now();
    tree_ = build_sah(geometry);
    view_ = tree_.view();
    build_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

AccelStats SahIntersector::stats() const {
    AccelStats stats;
    stats.build_s = build_s_;
    stats.bytes = tree_.nodes.capacity() * sizeof(SahNode) +
                  tree_.blocks.capacity() * sizeof(TriangleBlock) +
                  tree_.spheres.capacity() * sizeof(SahSphere);
    stats.node_count = tree_.inner_count + tree_.leaf_count;
    stats.leaf_count = tree_.leaf_count;
    stats.primitive_count = tree_.primitive_count;
    stats.skipped_count = tree_.skipped_count;
    stats.depth = tree_.depth;
    stats.sah_cost = tree_.sah_cost;
    return stats;
}

std::unique_ptr<SahIntersector> make_sah_intersector(const GeometryView& geometry,
                                                     TriangleTest test) {
    if (test == TriangleTest::moeller_trumbore)
        return std::make_unique<SahIntersectorWith<TriangleTest::moeller_trumbore>>(geometry);
    return std::make_unique<SahIntersectorWith<TriangleTest::watertight>>(geometry);
}

} // namespace plumb
