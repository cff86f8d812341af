#include "tools/gpu_src/image_check.h"

#include "accel/sah/build_compressed.h"
#include "accel/sah/build_sah.h"
#include "cuda/host_grid.h"
#include "renderer/scene/image_hash.h"
#include "tools/gpu_src/json.h"

#include <algorithm>
#include <cstdio>

namespace plumb::gpu {
namespace {

std::vector<std::filesystem::path> flat_files(const Options& options) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(options.flat))
        if (entry.path().extension() == ".flat" &&
            entry.path().stem().string().starts_with(options.only))
            files.push_back(entry.path());
    if (files.empty())
        throw std::runtime_error(options.flat.string() + ": no flat scenes");
    std::sort(files.begin(), files.end());
    return files;
}

struct Trees {
    SahTree binary;
    CompressedTree wide;

    explicit Trees(const GeometryView& geometry)
        : binary(build_sah(geometry)), wide(build_compressed(geometry)) {}
    [[nodiscard]] TreeViews views(CudaTree tree) const {
        TreeViews views;
        if (tree == CudaTree::binary)
            views.binary = binary.view();
        else
            views.wide = wide.view();
        return views;
    }
};

Film render_once(const Options& options, const FlatScene& flat, const RenderJob& job,
                 const TreeViews& trees, ImageResult& result, RenderStats& stats) {
    if (options.side == RaySide::device)
        return render_on_cuda(job, flat.needed, trees, flat.triangle_test, result.settings, {},
                              stats, &result.device);
    return render_on_host_grid(job, flat.needed, trees, flat.triangle_test, result.settings, {}, {},
                               stats);
}

/// More samples than the check has, so that a device is busy for a while; on the host the check's.
void take_times(const Options& options, const FlatScene& flat, RenderJob job,
                const TreeViews& trees, ImageResult& result) {
    if (options.side == RaySide::device)
        job.sampler.spp = options.quick ? 64 : 1024;
    std::vector<double> seconds;
    for (int i = 0; i < (options.side == RaySide::device ? options.repetitions : 1); ++i) {
        RenderStats stats;
        static_cast<void>(render_once(options, flat, job, trees, result, stats));
        seconds.push_back(stats.render_s);
        result.samples = stats.samples;
        result.rays = stats.rays;
    }
    std::sort(seconds.begin(), seconds.end());
    result.render_s = seconds[seconds.size() / 2];
}

void print(const ImageResult& r) {
    std::printf("%-24s %-5s %-7s %-11s %-10s %9.2f Mpaths/s %9.1f Mrays/s\n", r.scene.c_str(),
                r.profile.c_str(), name_of(r.settings.tree).data(),
                name_of(r.settings.schedule).data(),
                r.right()      ? "same bits"
                : r.same_image ? "RAYS"
                               : "BITS",
                1e-6 * static_cast<double>(r.samples) / r.render_s,
                1e-6 * static_cast<double>(r.rays.total()) / r.render_s);
    std::fflush(stdout);
}

} // namespace

void check_images(const Options& options, std::vector<ImageResult>& results) {
    for (const std::filesystem::path& file : flat_files(options)) {
        const FlatScene flat = read_flat(file);
        const FlatJob job(flat);
        const Trees trees(job.job().scene.geometry);
        for (const CudaSettings& settings : all_cuda_settings) {
            ImageResult result;
            result.scene = flat.name;
            result.settings = settings;
            result.build_s =
                settings.tree == CudaTree::binary ? trees.binary.build_s : trees.wide.build_s;
            RenderStats stats;
            const TreeViews views = trees.views(settings.tree);
            const Image image =
                render_once(options, flat, job.job(), views, result, stats).resolve();
            result.profile = stats.profile;
            result.same_image = hash_of(image) == flat.image_hash;
            result.same_rays = stats.rays.camera == flat.rays.camera &&
                               stats.rays.bounce == flat.rays.bounce &&
                               stats.rays.shadow == flat.rays.shadow;
            take_times(options, flat, job.job(), views, result);
            print(result);
            results.push_back(result);
        }
    }
}

std::string to_json(const ImageResult& r) {
    std::vector<std::string> kernels;
    for (const KernelReport& k : r.device.kernels)
        kernels.push_back(json_joined({json_member("name", json_text(k.name)),
                                       json_member("registers", std::to_string(k.registers)),
                                       json_member("local_bytes", std::to_string(k.local_bytes)),
                                       json_member("occupancy", json_number(k.occupancy))},
                                      '{', '}'));
    const auto rate = [&](std::uint64_t n) {
        return json_number(1e-6 * static_cast<double>(n) / r.render_s);
    };
    return json_joined({json_member("scene", json_text(r.scene)),
                        json_member("profile", json_text(r.profile)),
                        json_member("tree", json_text(name_of(r.settings.tree))),
                        json_member("schedule", json_text(name_of(r.settings.schedule))),
                        json_member("same_image", r.same_image ? "true" : "false"),
                        json_member("same_rays", r.same_rays ? "true" : "false"),
                        json_member("build_ms", json_number(1e3 * r.build_s)),
                        json_member("upload_ms", json_number(1e3 * r.device.upload_s)),
                        json_member("samples", std::to_string(r.samples)),
                        json_member("mpaths_per_s", rate(r.samples)),
                        json_member("mrays_per_s", rate(r.rays.total())),
                        json_member("kernels", json_joined(kernels, '[', ']'))},
                       '{', '}');
}

} // namespace plumb::gpu
