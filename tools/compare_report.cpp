#include "tools/compare_report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

namespace plumb {
namespace {

double largest_magnitude(const PerChannel& values) {
    return std::max({std::abs(values[0]), std::abs(values[1]), std::abs(values[2])});
}

/// Grows a list of complaints. A NaN is never within a limit.
class Complaints {
  public:
    void at_most(std::string_view name, double value, const std::optional<double>& limit) {
        if (limit && !(value <= *limit))
            lines_.push_back(fmt::format("{} is {:.6g}, above {:.6g}", name, value, *limit));
    }
    void at_least(std::string_view name, double value, const std::optional<double>& limit) {
        if (limit && !(value >= *limit))
            lines_.push_back(fmt::format("{} is {:.6g}, below {:.6g}", name, value, *limit));
    }
    void add(std::string line) { lines_.push_back(std::move(line)); }
    [[nodiscard]] std::vector<std::string> take() { return std::move(lines_); }

  private:
    std::vector<std::string> lines_;
};

void judge_z(const ZTest& z, double outliers, Complaints& complaints) {
    const double share =
        static_cast<double>(z.failed) / static_cast<double>(std::max<std::size_t>(z.tests, 1));
    if (share > outliers)
        complaints.add(fmt::format("{} of {} values fail the z-test (largest |z| {:.2f} at {}, {})",
                                   z.failed, z.tests, z.largest_z, z.largest_x, z.largest_y));
    if (!z.mean_passes())
        complaints.add(fmt::format("the image mean fails the z-test (z {:.2f} {:.2f} {:.2f})",
                                   z.mean_z[0], z.mean_z[1], z.mean_z[2]));
}

std::string json_number(double value) {
    return std::isfinite(value) ? fmt::format("{:.9g}", value) : "null";
}

std::string json_channels(const PerChannel& values) {
    return fmt::format("[{},{},{}]", json_number(values[0]), json_number(values[1]),
                       json_number(values[2]));
}

PerChannel ratios(const ImageComparison& m) {
    return {m.mean_ratio(0), m.mean_ratio(1), m.mean_ratio(2)};
}

std::string row(std::string_view name, const PerChannel& values) {
    return fmt::format("{:<14}{:<14.6g}{:<14.6g}{:<14.6g}\n", name, values[0], values[1],
                       values[2]);
}

} // namespace

std::vector<std::string> complaints(const CompareReport& report, const CompareOptions& options) {
    const ImageComparison& m = report.measures;
    Complaints found;
    found.at_most("MSE", m.mse, options.max_mse);
    found.at_most("relMSE", m.rel_mse, options.max_rel_mse);
    found.at_most("the largest difference", m.max_abs, options.max_abs);
    found.at_least("PSNR", m.psnr_db, options.min_psnr_db);
    found.at_most("the error of the mean", m.mean_error(), options.max_mean_error);
    found.at_most("|z| of the mean difference", largest_magnitude(m.mean_z), options.max_mean_z);
    if (m.non_finite > 0)
        found.add(fmt::format("{} values are NaN or infinite in one image only", m.non_finite));
    if (options.same_bits && m.different_bits > 0)
        found.add(fmt::format("{} values do not have the same bits", m.different_bits));
    if (report.z)
        judge_z(*report.z, options.outliers, found);
    return found.take();
}

std::string as_text(const CompareReport& report, const CompareOptions& options) {
    const ImageComparison& m = report.measures;
    std::string text = fmt::format("{:<14}{:.6g}\n{:<14}{:.6g}\n{:<14}{:.4f} dB\n", "MSE", m.mse,
                                   "relMSE", m.rel_mse, "PSNR", m.psnr_db);
    text += fmt::format("{:<14}{:.6g} at {}, {}\n", "max", m.max_abs, m.max_x, m.max_y);
    text +=
        fmt::format("{:<14}{} of {}\n", "bits differ", m.different_bits, m.values + m.non_finite);
    text += fmt::format("\n{:<14}{:<14}{:<14}{:<14}\n", "", "red", "green", "blue");
    text += row("mean A", m.mean_a) + row("mean B", m.mean_b) + row("A / B", ratios(m));
    text += row("z, scatter", m.mean_z);
    if (report.z) {
        const ZTest& z = *report.z;
        text += row("z, variance", z.mean_z);
        text += fmt::format(
            "\nz-test of pixels   {}: {} of {} fail at {:.2e} each, largest |z| {:.2f} at {}, {}\n",
            z.pixels_pass() ? "passed" : "failures", z.failed, z.tests, z.pixel_alpha, z.largest_z,
            z.largest_x, z.largest_y);
        text += fmt::format("z-test of the mean {}: smallest p {:.3g}, limit {:.3g}\n",
                            z.mean_passes() ? "passed" : "failed", z.mean_p, z.mean_alpha);
    }
    for (const std::string& line : complaints(report, options))
        text += "\nbeyond the threshold: " + line;
    return text.back() == '\n' ? text : text + '\n';
}

std::string as_json(const CompareReport& report, const CompareOptions& options) {
    const ImageComparison& m = report.measures;
    std::string text = fmt::format(
        R"({{"mse":{},"relmse":{},"psnr_db":{},"max":{},"max_at":[{},{}],"values":{},)"
        R"("non_finite":{},"different_bits":{},"mean_a":{},"mean_b":{},"mean_ratio":{},"mean_z_scatter":{})",
        json_number(m.mse), json_number(m.rel_mse), json_number(m.psnr_db), json_number(m.max_abs),
        m.max_x, m.max_y, m.values, m.non_finite, m.different_bits, json_channels(m.mean_a),
        json_channels(m.mean_b), json_channels(ratios(m)), json_channels(m.mean_z));
    if (report.z) {
        const ZTest& z = *report.z;
        text += fmt::format(
            R"(,"z_test":{{"tests":{},"failed":{},"pixel_alpha":{},"largest_z":{},"largest_at":[{},{}],)"
            R"("mean_z":{},"mean_p":{},"mean_alpha":{},"pixels_pass":{},"mean_passes":{}}})",
            z.tests, z.failed, json_number(z.pixel_alpha), json_number(z.largest_z), z.largest_x,
            z.largest_y, json_channels(z.mean_z), json_number(z.mean_p), json_number(z.mean_alpha),
            z.pixels_pass(), z.mean_passes());
    }
    return text + fmt::format(R"(,"within":{}}})", complaints(report, options).empty()) + "\n";
}

} // namespace plumb
