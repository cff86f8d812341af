#include "tools/warp_src/order.h"

#include "accel/math/bounds.h"

#include <algorithm>

namespace plumb::warps {
namespace {

/// Puts two zero bits behind each of the lower ten bits.
std::uint32_t spread(std::uint32_t bits) {
    std::uint32_t out = 0;
    for (std::uint32_t i = 0; i < 10; ++i)
        out |= (bits >> i & 1u) << (3 * i);
    return out;
}

std::uint64_t key_of(const Ray& ray, const Bounds& box) {
    std::uint64_t octant = 0, curve = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const float size = std::max(box.upper[axis] - box.lower[axis], 1e-30f);
        const float place = 1024 * (ray.origin[axis] - box.lower[axis]) / size;
        curve |= std::uint64_t{spread(static_cast<std::uint32_t>(std::clamp(place, 0.0f, 1023.0f)))}
                 << axis;
        octant |= std::uint64_t{ray.direction[axis] < 0 ? 1u : 0u} << axis;
    }
    return octant << 30 | curve;
}

} // namespace

std::vector<WarpWork> warps_of(const Gpu& gpu, std::uint32_t number, std::span<const Question> rays,
                               const Cost& besides) {
    std::vector<WarpWork> warps;
    for_warps(gpu, number, rays.size(), [&](std::size_t first, std::size_t end) {
        const auto lanes = rays.subspan(first, end - first);
        warps.push_back({Phase{{lanes.begin(), lanes.end()}, besides}});
    });
    return warps;
}

std::vector<Question> queue_of(std::span<const WarpWork> warps) {
    std::vector<Question> queue;
    for (const WarpWork& work : warps)
        for (const Phase& phase : work)
            queue.insert(queue.end(), phase.lanes.begin(), phase.lanes.end());
    return queue;
}

void sort_rays(std::vector<Question>& rays) {
    Bounds box;
    for (const Question& question : rays)
        box.extend(question.ray.origin);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(rays.size());
    for (std::uint32_t i = 0; i < keys.size(); ++i)
        keys[i] = {key_of(rays[i].ray, box), i};
    std::ranges::sort(keys);
    std::vector<Question> sorted;
    sorted.reserve(rays.size());
    for (const auto& [key, i] : keys)
        sorted.push_back(rays[i]);
    rays = std::move(sorted);
}

} // namespace plumb::warps
