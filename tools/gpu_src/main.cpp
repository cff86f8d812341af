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

/// What was found before all was done or something failed.
struct Found {
    std::string device = "host"; ///< its name
    std::vector<ImageResult> images;
    std::vector<RayResult> rays;

    [[nodiscard]] std::uint64_t wrong() const {
        std::uint64_t sum = 0;
        for (const ImageResult& image : images)
            sum += image.right() ? 0u : 1u;
        for (const RayResult& result : rays)
            for (const RayCell& cell : result.cells)
                sum += cell.wrong;
        return sum;
    }
};

void write_json(const Options& options, const Found& found, const std::string& failure) {
    std::vector<std::string> members{
        json_member("version", json_text(PLUMB_VERSION)),
        json_member("device", json_text(found.device)),
        json_member("quick", options.quick ? "true" : "false"),
        json_member("repetitions", std::to_string(options.repetitions)),
        json_member("images", json_list(found.images)),
        json_member("rays", json_list(found.rays))};
    if (!failure.empty())
        members.push_back(json_member("failure", json_text(failure)));
    std::ofstream out(options.json, std::ios::binary);
    out << json_joined(members, '{', '}', ",\n  ") << "\n";
    out.flush();
    if (!out)
        throw std::runtime_error(options.json.string() + ": cannot be written");
}

/// Exit codes. A device that fails is not one that is missing: tests skip where it is missing.
enum ExitCode : int { right = 0, wrong = 1, no_device = 6, device_failed = 7, internal = 70 };

/// Checks and times all that is asked for. An exit code, and what failed.
int measure(const Options& options, Found& found, std::string& failure) {
    try {
        if (options.side == RaySide::device)
            found.device = cuda_device_name();
        std::printf("on %s\n", found.device.c_str());
        if (options.images)
            check_images(options, found.images);
        if (options.rays)
            bench_rays(options, found.rays);
        return found.wrong() == 0 ? right : wrong;
    } catch (const NoDeviceError& error) {
        failure = error.what();
        return no_device;
    } catch (const DeviceError& error) {
        failure = error.what();
        return device_failed;
    } catch (const std::bad_alloc&) {
        failure = "out of memory";
        return device_failed;
    } catch (const std::exception& error) {
        failure = error.what();
        return internal;
    }
}

int run(const Options& options) {
    Found found;
    std::string failure;
    const int code = measure(options, found, failure);
    if (!options.json.empty() && code != no_device)
        write_json(options, found, failure);
    if (code == right)
        std::printf("all bits are those of the CPU\n");
    if (found.wrong() > 0)
        std::fprintf(stderr, "error: %llu images and hits are not those of the CPU\n",
                     static_cast<unsigned long long>(found.wrong()));
    if (!failure.empty())
        std::fprintf(stderr, "error: %s\n", failure.c_str());
    return code;
}

/// What fails before and after.
int run_and_report(const Options& options) {
    try {
        return run(options);
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
