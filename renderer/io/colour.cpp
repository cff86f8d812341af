#include "renderer/io/colour.h"

#include "display_ocio.h" // generated from scenes/display.ocio
#include "renderer/scene/error.h"

#include <OpenColorIO/OpenColorIO.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace plumb {
namespace {

namespace ocio = OCIO_NAMESPACE;

[[noreturn]] void refuse(const std::filesystem::path& config, const std::string& what) {
    throw SceneError(ErrorKind::usage, {config.string()}, what);
}

/// The configuration and the file that it came from, empty for the built-in one.
struct Config {
    std::filesystem::path file;
    ocio::ConstConfigRcPtr colours;
};

Config load(const DisplayOptions& options) {
    ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE); // errors come as exceptions
    Config config{options.config, nullptr};
    if (config.file.empty())
        if (const char* variable = std::getenv("OCIO"); variable && *variable)
            config.file = variable;
    try {
        if (config.file.empty()) {
            std::istringstream text(display_ocio);
            config.colours = ocio::Config::CreateFromStream(text);
        } else {
            config.colours = ocio::Config::CreateFromFile(config.file.c_str());
        }
    } catch (const std::exception& error) {
        refuse(config.file, std::string("no usable colour configuration: ") + error.what());
    }
    return config;
}

std::string view_of(const Config& config, const std::string& display, const std::string& wanted) {
    if (wanted.empty())
        return config.colours->getDefaultView(display.c_str());
    std::string known;
    for (int i = 0; i < config.colours->getNumViews(display.c_str()); ++i) {
        const std::string view = config.colours->getView(display.c_str(), i);
        if (view == wanted)
            return view;
        known += (known.empty() ? "" : ", ") + view;
    }
    refuse(config.file, "unknown view (got '" + wanted + "', expected one of " + known + ")");
}

/// Linear Rec. 709 to CIE XYZ, both with white D65 (from the primaries of ITU-R BT.709-6).
// clang-format off
constexpr double rec709_to_xyz[16] = {
    0.412390799265959,  0.357584339383878, 0.180480788401834,  0,
    0.21263900587151,   0.715168678767756, 0.0721923153607337, 0,
    0.0193308187155918, 0.119194779794626, 0.950532152249661,  0,
    0,                  0,                 0,                  1};
// clang-format on

/// Our linear Rec. 709 to the space that a configuration's views start from. One that says where
/// ACES2065-1 is gets an exact conversion; else its `scene_linear` is taken to be Rec. 709.
ocio::GroupTransformRcPtr transform_of(const Config& config, const std::string& view) {
    const std::string display = config.colours->getDefaultDisplay();
    const bool aces = config.colours->hasRole("aces_interchange");
    auto group = ocio::GroupTransform::Create();
    if (aces) {
        auto to_xyz = ocio::MatrixTransform::Create();
        to_xyz->setMatrix(rec709_to_xyz);
        auto to_aces = ocio::BuiltinTransform::Create();
        to_aces->setStyle("UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD");
        to_aces->setDirection(ocio::TRANSFORM_DIR_INVERSE);
        group->appendTransform(to_xyz);
        group->appendTransform(to_aces);
    }
    auto to_display = ocio::DisplayViewTransform::Create();
    to_display->setSrc(aces ? "aces_interchange" : ocio::ROLE_SCENE_LINEAR);
    to_display->setDisplay(display.c_str());
    to_display->setView(view.c_str());
    group->appendTransform(to_display);
    return group;
}

/// Lossless: the default replaces powers by faster approximations.
ocio::ConstCPUProcessorRcPtr processor_of(const DisplayOptions& options) {
    if (!std::isfinite(options.exposure))
        refuse({}, "bad exposure (expected a finite number of stops)");
    const Config config = load(options);
    const std::string view = view_of(config, config.colours->getDefaultDisplay(), options.view);
    try {
        return config.colours->getProcessor(transform_of(config, view))
            ->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
    } catch (const std::exception& error) {
        refuse(config.file, "view '" + view + "': " + error.what());
    }
}

/// What a view is given: no NaN and nothing infinite, which transforms do not define.
float defined(float value) {
    constexpr float largest_half = 65504;
    return std::isnan(value) ? 0 : std::clamp(value, -largest_half, largest_half);
}

std::uint8_t code(float value) {
    const float clamped = std::isnan(value) ? 0 : std::clamp(value, 0.0f, 1.0f);
    return static_cast<std::uint8_t>(std::floor(255 * clamped + 0.5f));
}

} // namespace

void check_display(const DisplayOptions& options) { static_cast<void>(processor_of(options)); }

std::vector<std::uint8_t> display_pixels(const Image& image, const DisplayOptions& options) {
    const auto processor = processor_of(options);
    const float scale = std::exp2(options.exposure);
    std::vector<float> values;
    values.reserve(3 * image.pixels.size());
    for (const Rgb& pixel : image.pixels) {
        const Rgb c = pixel * scale;
        values.insert(values.end(), {defined(c.r), defined(c.g), defined(c.b)});
    }
    if (!values.empty()) {
        ocio::PackedImageDesc description(values.data(), image.width, image.height, 3);
        processor->apply(description);
    }
    std::vector<std::uint8_t> codes(values.size());
    std::transform(values.begin(), values.end(), codes.begin(), code);
    return codes;
}

} // namespace plumb
