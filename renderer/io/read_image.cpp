#include "renderer/io/read_image.h"

#include "renderer/io/colour.h"
#include "renderer/io/exr_file.h"
#include "renderer/io/image_codec.h"
#include "renderer/io/image_format.h"
#include "renderer/io/input_file.h"
#include "renderer/scene/error.h"

#include <exception>

namespace plumb {
namespace {

Image rgb_of(const DecodedImage& decoded) {
    Image image{decoded.width, decoded.height, decoded.width, decoded.height, 0, 0, {}, {}};
    const auto channels = static_cast<std::size_t>(decoded.channels);
    const std::size_t green = channels >= 3 ? 1 : 0, blue = channels >= 3 ? 2 : 0;
    image.pixels.reserve(decoded.values.size() / channels);
    for (std::size_t i = 0; i < decoded.values.size(); i += channels)
        image.pixels.push_back(
            {decoded.values[i], decoded.values[i + green], decoded.values[i + blue]});
    return image;
}

} // namespace

Image read_image(const std::filesystem::path& path, PixelDecoding decoding) {
    const auto format = image_format_of(path);
    if (!format)
        throw SceneError(ErrorKind::mesh, {path.string()},
                         "unknown image format (got '" + path.extension().string() +
                             "', expected one of " + image_extensions() + ")");
    if (*format == ImageFormat::exr)
        return read_exr(path).image;
    const std::string file = read_file(path, ErrorKind::mesh);
    try {
        const DecodedImage decoded = decode_image(*format, file);
        Image image = rgb_of(decoded);
        if (!decoded.floating && decoding == PixelDecoding::srgb)
            for (Rgb& c : image.pixels)
                c = {srgb_to_linear(c.r), srgb_to_linear(c.g), srgb_to_linear(c.b)};
        return image;
    } catch (const std::exception& error) {
        throw SceneError(ErrorKind::mesh, {path.string()},
                         std::string("not a readable image: ") + error.what());
    }
}

} // namespace plumb
