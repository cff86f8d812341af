#include "tools/warp_src/ray_model.h"

namespace plumb::warps {

const char* name_of(RayWay way) {
    switch (way) {
    case RayWay::as_built: return "as built";
    case RayWay::together: return "together";
    case RayWay::sorted: return "sorted";
    case RayWay::persistent: return "persistent";
    }
    return "";
}

RayCell model_cell(const TreeViews& trees, CudaTree tree, bench::RayKind kind,
                   std::span<const Question> rays, RayWay way) {
    const Gpu gpu;
    Kernel kernel{tree};
    if (!rays.empty() && rays.front().any_hit)
        kernel.registers = any_hit_registers;
    if (way == RayWay::together)
        kernel.loop = Loop::together;
    if (way == RayWay::persistent) {
        kernel.registers = persistent_registers;
        kernel.refill_at = persistent_refill_at;
    }
    std::vector<Question> sorted;
    if (way == RayWay::sorted) {
        sorted.assign(rays.begin(), rays.end());
        sort_rays(sorted);
        rays = sorted;
    }
    RayCell cell{kind, tree, way, {}};
    for (const std::uint32_t number : looked_at) {
        Multiprocessor processor(gpu, Costs{}, trees, kernel);
        const auto warps = warps_of(gpu, number, rays, {});
        if (way == RayWay::persistent)
            processor.run(queue_of(warps));
        else
            processor.run(warps);
        cell.totals += processor.totals();
    }
    cell.rays_per_s = static_cast<double>(cell.totals.rays) / Clocks(cell.totals, gpu).most() *
                      gpu.clock_hz * gpu.multiprocessors;
    return cell;
}

} // namespace plumb::warps
