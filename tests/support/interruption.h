/// \file  An intersector that asks for the end of the render in the middle of it.
#pragma once

#include "accel/intersector.h"

#include <algorithm>
#include <atomic>

namespace plumb::test {

/// Passes rays on, and asks for the end of the render after so many streams. For one thread.
class Interruption final : public Intersector {
  public:
    Interruption(const Intersector& inner, int streams, std::atomic<bool>& cancel)
        : inner_(inner), streams_left_(streams), cancel_(cancel) {}

    [[nodiscard]] Hit closest(const Ray& ray) const override { return inner_.closest(ray); }
    [[nodiscard]] bool occluded(const Ray& ray) const override { return inner_.occluded(ray); }
    void closest(std::span<const Ray> rays, std::span<Hit> hits) const override {
        longest_ = std::max(longest_, rays.size());
        if (--streams_left_ == 0)
            cancel_ = true;
        inner_.closest(rays, hits);
    }
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> found) const override {
        inner_.occluded(rays, found);
    }
    [[nodiscard]] AccelStats stats() const override { return inner_.stats(); }
    [[nodiscard]] std::size_t longest() const { return longest_; }

  private:
    const Intersector& inner_;
    mutable int streams_left_;
    mutable std::size_t longest_ = 0;
    std::atomic<bool>& cancel_;
};

} // namespace plumb::test
