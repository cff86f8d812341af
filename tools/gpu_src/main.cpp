/// \file  plumb_gpu: the kernels on a GPU against what the CPU rendered, and how fast they are.

#include "cuda/cuda_render.h"
#include "tools/gpu_src/image_check.h"
#include "tools/gpu_src/json.h"
#include "tools/gpu_src/ray_bench.h"

#include <cstdio>
#include <fstream>
#include <new>

namespace plumb::gpu {
namespace {

template <class Result> std::string json_list(const std::vector<Result>& results) {
    std::vector<std::string> parts;
    for (const Result& result : results)
        parts.push_back(to_json(result));
    return json_joined(parts, '[', ']', ",\n    ");
}

void write_json(const Options& options, const std::string& device,
                const std::vector<ImageResult>& images, const std::vector<RayResult>& rays) {
    std::ofstream out(options.json, std::ios::binary);
    out << json_joined({json_member("version", json_text(PLUMB_VERSION)),
                        json_member("device", json_text(device)),
                        json_member("quick", options.quick ? "true" : "false"),
                        json_member("repetitions", std::to_string(options.repetitions)),
                        json_member("images", json_list(images)),
                        json_member("rays", json_list(rays))},
                       '{', '}', ",\n  ")
        << "\n";
    out.flush();
    if (!out)
        throw std::runtime_error(options.json.string() + ": cannot be written");
}

int run(const Options& options) {
    std::string device = "host";
    if (options.side == RaySide::device) {
        std::string why;
        if (!cuda_available(&why))
            throw DeviceError(why);
        device = cuda_device_name();
    }
    std::printf("on %s\n", device.c_str());
    std::vector<ImageResult> images;
    std::vector<RayResult> rays;
    if (options.images)
        images = check_images(options);
    if (options.rays)
        rays = bench_rays(options);
    if (!options.json.empty())
        write_json(options, device, images, rays);
    std::uint64_t wrong = 0;
    for (const ImageResult& image : images)
        wrong += image.right() ? 0u : 1u;
    for (const RayResult& result : rays)
        for (const RayCell& cell : result.cells)
            wrong += cell.wrong;
    if (wrong == 0) {
        std::printf("all bits are those of the CPU\n");
        return 0;
    }
    std::fprintf(stderr, "error: %llu images and hits are not those of the CPU\n",
                 static_cast<unsigned long long>(wrong));
    return 1;
}

/// The one place where exceptions become exit codes; they are those of renderer.
int run_and_report(const Options& options) {
    constexpr int resources = 6, internal = 70;
    try {
        return run(options);
    } catch (const DeviceError& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return resources;
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "error: out of memory\n");
        return resources;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return internal;
    }
}

} // namespace
} // namespace plumb::gpu

int main(int argc, char** argv) {
    const auto parsed = plumb::gpu::parse_options(argc, argv);
    return parsed.exit_code ? *parsed.exit_code : plumb::gpu::run_and_report(parsed.options);
}
