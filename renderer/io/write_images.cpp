#include "renderer/io/write_images.h"

#include "renderer/io/colour.h"
#include "renderer/io/exr_file.h"
#include "renderer/io/image_codec.h"
#include "renderer/io/image_format.h"
#include "renderer/io/write_file.h"
#include "renderer/scene/error.h"

#include <exception>

namespace plumb {
namespace {

using std::filesystem::path;

constexpr int jpeg_largest_side = 65500;

ImageFormat format_or_refuse(const path& file) {
    if (const auto format = image_format_of(file))
        return *format;
    const std::string extension = file.extension().string();
    throw SceneError(ErrorKind::output, {file.string()},
                     "unknown image format (got '" +
                         (extension.empty() ? "no extension" : extension) + "', expected one of " +
                         image_extensions() + ")");
}

DisplayOptions display_options(const OutputOptions& options) {
    return {options.view, options.exposure, options.ocio_config};
}

/// The same file under two spellings is the same file.
void refuse_duplicates(const std::vector<path>& files) {
    std::vector<path> seen;
    for (const path& file : files) {
        std::error_code error;
        path real = std::filesystem::weakly_canonical(file, error);
        if (error)
            real = file.lexically_normal();
        for (const path& other : seen)
            if (other == real)
                throw SceneError(ErrorKind::usage, {file.string()}, "is named twice as an output");
        seen.push_back(real);
    }
}

void check_jpeg(const path& file, int width, int height) {
    if (width <= jpeg_largest_side && height <= jpeg_largest_side)
        return;
    throw SceneError(ErrorKind::output, {file.string()},
                     "too large for a JPEG (got " + std::to_string(width) + "x" +
                         std::to_string(height) + ", expected at most " +
                         std::to_string(jpeg_largest_side) + " a side)");
}

template <typename T> PixelView<T> view(const Image& image, std::span<const T> values) {
    return {image.width, image.height, values};
}

std::string encode_display(ImageFormat format, const Image& image, const OutputOptions& options,
                           const Metadata& metadata) {
    const auto codes = display_pixels(image, display_options(options));
    return encode_image(format, view<std::uint8_t>(image, codes), metadata);
}

std::string encode(const path& file, const Image& image, const OutputOptions& options,
                   const Metadata& metadata) {
    const ImageFormat format = format_or_refuse(file);
    if (format == ImageFormat::exr)
        return encode_exr(image, {options.half, options.compression}, metadata);
    if (is_display_format(format))
        return encode_display(format, image, options, metadata);
    const float* first = &image.pixels.data()->r;
    return encode_image(format, view<float>(image, {first, 3 * image.pixels.size()}), metadata);
}

} // namespace

void check_outputs(const OutputOptions& options, int width, int height) {
    refuse_duplicates(options.files);
    bool display = false;
    for (const path& file : options.files) {
        const ImageFormat format = format_or_refuse(file);
        if (format == ImageFormat::jpeg)
            check_jpeg(file, width, height);
        display = display || is_display_format(format);
        check_writable(file);
    }
    check_exr_compression(options.compression);
    if (display || !options.view.empty())
        check_display(display_options(options));
}

void write_images(const Image& image, const OutputOptions& options, const Metadata& metadata) {
    check_outputs(options, image.width, image.height);
    if (image.pixels.empty() && !options.files.empty())
        throw SceneError(ErrorKind::output, {}, "an image without pixels cannot be written");
    for (const path& file : options.files) {
        std::string bytes;
        try {
            bytes = encode(file, image, options, metadata);
        } catch (const SceneError&) {
            throw;
        } catch (const std::exception& error) {
            throw SceneError(ErrorKind::output, {file.string()}, error.what());
        }
        atomic_write(file, bytes);
    }
}

} // namespace plumb
