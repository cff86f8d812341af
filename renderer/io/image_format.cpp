#include "renderer/io/image_format.h"

#include <array>
#include <string_view>

namespace plumb {
namespace {

struct Extension {
    std::string_view name;
    ImageFormat format;
};
constexpr std::array<Extension, 9> extensions{{
    {"exr", ImageFormat::exr},
    {"hdr", ImageFormat::hdr},
    {"tif", ImageFormat::tiff},
    {"tiff", ImageFormat::tiff},
    {"pfm", ImageFormat::pfm},
    {"png", ImageFormat::png},
    {"jpg", ImageFormat::jpeg},
    {"jpeg", ImageFormat::jpeg},
    {"ppm", ImageFormat::ppm},
}};

/// ASCII only, whatever the locale.
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

} // namespace

std::optional<ImageFormat> image_format_of(const std::filesystem::path& path) {
    std::string name = path.extension().string();
    for (char& c : name)
        c = lower(c);
    for (const Extension& known : extensions)
        if (name.size() == known.name.size() + 1 && name.compare(1, name.npos, known.name) == 0)
            return known.format;
    return std::nullopt;
}

std::string image_extensions() {
    std::string names;
    for (const Extension& known : extensions)
        names += (names.empty() ? "" : ", ") + std::string(known.name);
    return names;
}

} // namespace plumb
