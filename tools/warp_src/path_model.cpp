#include "tools/warp_src/path_model.h"

#include "cuda/wavefront.h"

namespace plumb::warps {
namespace {

/// Traces and takes note.
struct RecordingQuery {
    TreeQuery<TriangleTest::watertight, CudaTree::binary> query;
    PathRays& path;

    [[nodiscard]] Hit closest(const Ray& ray) const {
        path.push_back({ray});
        return query.closest(ray);
    }
    [[nodiscard]] bool occluded(const Ray& ray) const {
        path.back().shadow = ray;
        return query.occluded(ray);
    }
};

/// What a path and its shadow ray write and read between the stages of one depth: the state twice,
/// hit and places, the shadow ray and what it brings.
constexpr double state_bytes = 3 * sizeof(PathState) + 2 * sizeof(Hit) + 4 * sizeof(std::uint32_t);
constexpr double shadow_bytes = 2 * sizeof(ShadowEntry) + 2 * sizeof(Rgb);

WarpWork megakernel_work(std::span<const PathRays> paths, const Costs& costs) {
    WarpWork work;
    for (std::size_t depth = 0;; ++depth) {
        Phase extend{{}, costs.shade}, shadow;
        for (const PathRays& path : paths) {
            if (depth >= path.size())
                continue;
            extend.lanes.push_back({path[depth].ray, false});
            if (path[depth].shadow)
                shadow.lanes.push_back({*path[depth].shadow, true});
        }
        if (extend.lanes.empty())
            return work;
        work.push_back(std::move(extend));
        if (!shadow.lanes.empty())
            work.push_back(std::move(shadow));
    }
}

Totals megakernel(const Gpu& gpu, const Costs& costs, Multiprocessor& processor,
                  std::uint32_t number, std::span<const PathRays> paths) {
    std::vector<WarpWork> warps;
    for_warps(gpu, number, paths.size(), [&](std::size_t first, std::size_t end) {
        warps.push_back(megakernel_work(paths.subspan(first, end - first), costs));
    });
    processor.run(warps);
    return processor.totals();
}

/// Stages of the wavefront on one multiprocessor.
class Wavefront {
  public:
    Wavefront(const Gpu& gpu, const Costs& costs, const TreeViews& trees, CudaTree tree,
              PathWay way, std::uint32_t number)
        : gpu_(gpu), costs_(costs), way_(way), number_(number), kernels_(gpu, costs, trees, {tree}),
          persistent_(gpu, costs, trees, {tree, persistent_registers, {}, persistent_refill_at}) {}

    [[nodiscard]] Totals run(std::span<const PathRays> paths) {
        double bytes = 0;
        for (std::size_t depth = 0;; ++depth) {
            std::vector<Question> extend, shadow;
            for (const PathRays& path : paths) {
                if (depth >= path.size())
                    continue;
                extend.push_back({path[depth].ray, false});
                if (path[depth].shadow)
                    shadow.push_back({*path[depth].shadow, true});
            }
            if (extend.empty())
                break;
            bytes += state_bytes * static_cast<double>(extend.size()) +
                     shadow_bytes * static_cast<double>(shadow.size());
            trace_and_shade(std::move(extend), depth > 0);
            kernels_.run(warps_of(gpu_, number_, shadow, {}));
        }
        Totals totals = kernels_.totals();
        totals += persistent_.totals();
        totals.memory_bytes = bytes / gpu_.multiprocessors;
        return totals;
    }

  private:
    void trace_and_shade(std::vector<Question> rays, bool without_order) {
        if (without_order && way_ == PathWay::sorted_wavefront)
            sort_rays(rays);
        const auto warps = warps_of(gpu_, number_, rays, costs_.shade);
        if (!without_order || way_ != PathWay::persistent_wavefront)
            return kernels_.run(warps);
        persistent_.run(queue_of(warps));
        for (const WarpWork& work : warps)
            persistent_.besides(costs_.shade, work[0].lanes.size());
    }

    Gpu gpu_;
    Costs costs_;
    PathWay way_;
    std::uint32_t number_;
    Multiprocessor kernels_, persistent_;
};

} // namespace

const char* name_of(PathWay way) {
    switch (way) {
    case PathWay::megakernel: return "megakernel";
    case PathWay::wavefront: return "wavefront";
    case PathWay::sorted_wavefront: return "wavefront, sorted";
    case PathWay::persistent_wavefront: return "wavefront, persistent";
    }
    return "";
}

std::vector<PathRays> record_paths(const RenderJob& job, const SahView& tree) {
    const TreeViews trees{tree, {}};
    const Batch all{
        0, static_cast<std::uint32_t>(job.crop.width) * static_cast<std::uint32_t>(job.crop.height),
        0, job.sampler.spp};
    std::vector<PathRays> paths(all.slots());
    RayCounts counts;
    for (std::uint32_t slot = 0; slot < all.slots(); ++slot) {
        const SlotSample at(job.crop, all, slot);
        const RecordingQuery query{{trees}, paths[slot]};
        static_cast<void>(sample_pixel<full_profile>(job, query, at.x, at.y, at.index, counts));
    }
    return paths;
}

PathCell model_cell(const TreeViews& trees, CudaTree tree, std::span<const PathRays> paths,
                    PathWay way) {
    const Gpu gpu;
    const Costs costs;
    PathCell cell{tree, way, {}};
    for (const std::uint32_t number : looked_at) {
        if (way == PathWay::megakernel) {
            Multiprocessor processor(gpu, costs, trees, {tree, megakernel_registers});
            cell.totals += megakernel(gpu, costs, processor, number, paths);
        } else {
            cell.totals += Wavefront(gpu, costs, trees, tree, way, number).run(paths);
        }
    }
    // Each multiprocessor has the same share of a wave but for what does not divide.
    cell.paths = static_cast<double>(paths.size() * looked_at.size()) / gpu.multiprocessors;
    cell.paths_per_s =
        cell.paths / Clocks(cell.totals, gpu).most() * gpu.clock_hz * gpu.multiprocessors;
    return cell;
}

} // namespace plumb::warps
