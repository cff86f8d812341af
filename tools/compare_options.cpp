#include "tools/compare_options.h"

#include "renderer/unknown_argument.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {
namespace {

constexpr const char* description =
    "Compares image A with the reference B: MSE, relMSE = mean(d^2 / (b^2 + 0.01)), PSNR, largest\n"
    "difference and means. Where variance and sample counts are known (an EXR rendered with\n"
    "variance carries both), also a z-test of every pixel, Sidak-corrected, and of the image "
    "mean.\n"
    "Exit code: 0 within the thresholds, 1 beyond one or a z-test failed, 2 usage, 4 an image\n"
    "cannot be read or the sizes differ, 5 the picture cannot be written.";

void add_thresholds(CLI::App& app, CompareOptions& options) {
    app.add_option("--max-mse", options.max_mse, "Largest mean squared error");
    app.add_option("--max-relmse", options.max_rel_mse, "Largest relMSE");
    app.add_option("--max-abs", options.max_abs, "Largest difference of any value");
    app.add_option("--min-psnr", options.min_psnr_db, "Smallest PSNR in dB, peak 1");
    app.add_option("--max-mean-error", options.max_mean_error,
                   "Largest |mean A / mean B - 1| of a channel: 0.005 is half a percent");
    app.add_option("--max-mean-z", options.max_mean_z,
                   "Largest |z| of a channel's mean difference, its noise taken from the scatter\n"
                   "of the differences: needs no variance");
    app.add_flag("--same-bits", options.same_bits, "Every value must have the same bits");
}

void add_z_test(CLI::App& app, CompareOptions& options) {
    app.add_option("--spp-a", options.spp_a, "Samples per pixel of A (default: the EXR's 'spp')");
    app.add_option("--spp-b", options.spp_b, "Samples per pixel of B; inf for an exact image");
    app.add_option("--variance-a", options.variance_a,
                   "Image with the variance of one sample of A (default: the EXR's own layer; an\n"
                   "image without variance is taken to have the other's)");
    app.add_option("--variance-b", options.variance_b, "The same for B");
    app.add_option("--alpha", options.alpha, "Chance that each z-test fails without a cause")
        ->check(CLI::Range(1e-12, 0.5))
        ->capture_default_str();
    app.add_option("--outliers", options.outliers,
                   "Share of the pixel channels that may fail their z-test: few samples of a\n"
                   "skewed distribution are not normal")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    app.add_flag("!--no-z-test", options.z_test, "Leave the z-tests out");
}

} // namespace

ParsedCompareOptions parse_compare_options(int argc, char** argv) {
    ParsedCompareOptions parsed;
    CompareOptions& options = parsed.options;
    CLI::App app(description, "compare");
    app.set_version_flag("--version", "Plumbline " PLUMB_VERSION);
    app.add_option("A", options.a, "Image to judge")->required();
    app.add_option("B", options.b, "Reference")->required();
    app.add_option(
        "-o,--output", options.difference,
        "Difference picture: red where A is brighter, blue where B is, black where they\n"
        "agree; as exr, pfm or tif the signed differences A - B");
    app.add_option("--scale", options.scale,
                   "Difference shown at full brightness (default: 99 % of the pixels are below)")
        ->check(CLI::PositiveNumber);
    app.add_flag("--json", options.json, "One JSON object in place of the table");
    add_thresholds(app, options);
    add_z_test(app, options);
    app.allow_extras();
    try {
        app.parse(argc, argv);
        if (!app.remaining().empty())
            throw CLI::ExtrasError(app.remaining());
    } catch (const CLI::Success& request) {
        parsed.exit_code = app.exit(request);
    } catch (const CLI::ParseError& error) {
        const std::string what = app.remaining().empty() ? error.what() : unknown_argument(app);
        fmt::print(stderr, "error: {} (see --help)\n", what);
        parsed.exit_code = 2;
    }
    return parsed;
}

} // namespace plumb
