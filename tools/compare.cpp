/// \file  plumb_compare: two images in, how far they lie apart out.
#include "renderer/io/exr_file.h"
#include "renderer/io/image_format.h"
#include "renderer/io/read_image.h"
#include "renderer/io/write_images.h"
#include "renderer/scene/error.h"
#include "tools/compare_options.h"
#include "tools/compare_picture.h"
#include "tools/compare_report.h"
#include "tools/exit_code.h"

#include <cstdio>

namespace plumb {
namespace {

/// An image and what is known of its samples.
struct Subject {
    Image image;
    std::optional<double> spp;
};

std::optional<double> spp_in(const Metadata& metadata) {
    for (const auto& [name, value] : metadata)
        if (name == "spp") {
            if (const int* count = std::get_if<int>(&value))
                return *count;
            if (const float* count = std::get_if<float>(&value))
                return double{*count};
        }
    return std::nullopt;
}

Subject read_subject(const std::filesystem::path& path, const std::filesystem::path& variance,
                     const std::optional<double>& spp) {
    Subject subject;
    if (image_format_of(path) == ImageFormat::exr) {
        ExrContents contents = read_exr(path);
        subject = {std::move(contents.image), spp_in(contents.metadata)};
    } else {
        subject.image = read_image(path);
    }
    if (spp)
        subject.spp = spp;
    if (!variance.empty()) {
        const Image read = read_image(variance);
        if (read.width != subject.image.width || read.height != subject.image.height)
            throw SceneError(ErrorKind::mesh, {variance.string()},
                             "the variance differs in size from its image");
        subject.image.variance = read.pixels;
    }
    return subject;
}

CompareReport report_on(const Subject& a, const Subject& b, const CompareOptions& options) {
    CompareReport report{compare(a.image, b.image), std::nullopt};
    const bool variance = !a.image.variance.empty() || !b.image.variance.empty();
    if (options.z_test && variance && a.spp && b.spp)
        report.z = z_test(a.image, *a.spp, b.image, *b.spp, options.alpha);
    return report;
}

void write_difference(const Image& a, const Image& b, const CompareOptions& options) {
    const auto format = image_format_of(options.difference);
    const bool display = format && is_display_format(*format);
    OutputOptions output;
    output.files = {options.difference};
    const Metadata metadata{{"software", "Plumbline " PLUMB_VERSION},
                            {"difference", options.a.string() + " - " + options.b.string()}};
    write_images(display ? difference_picture(a, b, options.scale) : signed_difference(a, b),
                 output, metadata);
}

int run(const CompareOptions& options) {
    const Subject a = read_subject(options.a, options.variance_a, options.spp_a);
    const Subject b = read_subject(options.b, options.variance_b, options.spp_b);
    const CompareReport report = report_on(a, b, options);
    if (!options.difference.empty())
        write_difference(a.image, b.image, options);
    const std::string text = options.json ? as_json(report, options) : as_text(report, options);
    std::fputs(text.c_str(), stdout);
    return complaints(report, options).empty() ? 0 : 1;
}

} // namespace
} // namespace plumb

int main(int argc, char** argv) {
    return plumb::exit_code_of([&] {
        const auto parsed = plumb::parse_compare_options(argc, argv);
        return parsed.exit_code ? *parsed.exit_code : plumb::run(parsed.options);
    });
}
