/// \file  The command line of plumb_compare.
#pragma once

#include <filesystem>
#include <optional>

namespace plumb {

struct CompareOptions {
    std::filesystem::path a, b;                   ///< b is the reference
    std::filesystem::path difference;             ///< picture to write; empty: none
    std::optional<float> scale;                   ///< difference that is shown at full brightness
    std::filesystem::path variance_a, variance_b; ///< files; empty: the layer in the EXR itself
    std::optional<double> spp_a, spp_b;           ///< else the EXR's own `spp`
    double alpha = 0.01;                          ///< of each z-test
    double outliers = 0; ///< share of pixel channels that may fail the z-test
    bool z_test = true;  ///< where variance and sample counts are known
    bool json = false;
    bool same_bits = false; ///< demand bit for bit equal pixels
    std::optional<double> max_mse, max_rel_mse, max_abs, min_psnr_db, max_mean_error, max_mean_z;
};

/// Options, or the exit code where there is nothing to do: 0 after --help and --version, 2 for a
/// mistake, which is explained on stderr.
struct ParsedCompareOptions {
    CompareOptions options;
    std::optional<int> exit_code;
};
[[nodiscard]] ParsedCompareOptions parse_compare_options(int argc, char** argv);

} // namespace plumb
