#include "cuda/host_grid.h"

namespace plumb {
namespace {

struct Work {
    const RenderJob& job;
    const DeviceJob& device;
    const HostGrid& grid;
    const RenderOptions& options;
    RenderStats& stats;

    template <class Executor, class... Schedule>
    [[nodiscard]] Film run(Schedule... schedule) const {
        Executor executor(device, grid, schedule...);
        return BatchRenderer(job, options, executor, stats).render(grid.chunk_pixels);
    }
    template <Features F, TriangleTest Test, CudaTree Tree>
    [[nodiscard]] Film scheduled(CudaSchedule schedule) const {
        return schedule == CudaSchedule::megakernel ? run<HostExecutor<F, Test, Tree>>()
                                                    : run<HostWaves<F, Test, Tree>>(schedule);
    }
    template <Features F, TriangleTest Test>
    [[nodiscard]] Film with(const CudaSettings& settings) const {
        return settings.tree == CudaTree::binary
                   ? scheduled<F, Test, CudaTree::binary>(settings.schedule)
                   : scheduled<F, Test, CudaTree::wide>(settings.schedule);
    }
};

} // namespace

Film render_on_host_grid(const RenderJob& job, const Features& needed, const TreeViews& trees,
                         TriangleTest test, const CudaSettings& settings, const HostGrid& grid,
                         const RenderOptions& options, RenderStats& stats) {
    HostBlock block(placed_size(job, trees));
    Arena arena = block.arena();
    DeviceJob device = place(job, trees, arena);
    device.with_variance = options.variance;
    const PathKernel kernel = path_kernel_for(needed, test, options.force_full_profile);
    stats.profile = profile_name(kernel == PathKernel::box ? box_profile : full_profile);
    const Work work{job, device, grid, options, stats};
    switch (kernel) {
    case PathKernel::box: return work.with<box_profile, TriangleTest::watertight>(settings);
    case PathKernel::full: return work.with<full_profile, TriangleTest::watertight>(settings);
    case PathKernel::full_moeller_trumbore: break;
    }
    return work.with<full_profile, TriangleTest::moeller_trumbore>(settings);
}

} // namespace plumb
