#include "renderer/io/exr_file.h"

#include "renderer/scene/error.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfCompression.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <half.h>
#include <thread>
#include <utility>

namespace plumb {
namespace {

struct NamedCompression {
    const char* name;
    Imf::Compression compression;
};
constexpr std::array<NamedCompression, 10> known_compressions{{
    {"none", Imf::NO_COMPRESSION},
    {"rle", Imf::RLE_COMPRESSION},
    {"zips", Imf::ZIPS_COMPRESSION},
    {"zip", Imf::ZIP_COMPRESSION},
    {"piz", Imf::PIZ_COMPRESSION},
    {"pxr24", Imf::PXR24_COMPRESSION},
    {"b44", Imf::B44_COMPRESSION},
    {"b44a", Imf::B44A_COMPRESSION},
    {"dwaa", Imf::DWAA_COMPRESSION},
    {"dwab", Imf::DWAB_COMPRESSION},
}};

/// Collects a file in memory.
class StringStream final : public Imf::OStream {
  public:
    StringStream() : Imf::OStream("memory") {}
    void write(const char bytes[], int count) override {
        const auto n = static_cast<std::size_t>(count);
        bytes_.resize(std::max(bytes_.size(), position_ + n));
        std::copy_n(bytes, n, bytes_.begin() + static_cast<std::ptrdiff_t>(position_));
        position_ += n;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }
    [[nodiscard]] std::string take() { return std::move(bytes_); }

  private:
    std::string bytes_;
    std::size_t position_ = 0;
};

Imf::Compression compression_named(const std::string& name) {
    for (const NamedCompression& known : known_compressions)
        if (name == known.name)
            return known.compression;
    throw SceneError(ErrorKind::usage, {},
                     "unknown EXR compression (got '" + name + "', expected one of " +
                         exr_compressions() + ")");
}

struct AttributeWriter {
    Imf::Header& header;
    const std::string& name;
    void operator()(const std::string& value) const {
        header.insert(name, Imf::StringAttribute(value));
    }
    void operator()(float value) const { header.insert(name, Imf::FloatAttribute(value)); }
    void operator()(int value) const { header.insert(name, Imf::IntAttribute(value)); }
};

Imf::Header header_of(const Image& image, const ExrOptions& options, const Metadata& metadata) {
    const Imath::Box2i display({0, 0}, {image.full_width - 1, image.full_height - 1});
    const Imath::V2i corner(image.offset_x, image.offset_y);
    const Imath::Box2i data(corner, corner + Imath::V2i(image.width - 1, image.height - 1));
    Imf::Header header(image.full_width > 0 && image.full_height > 0 ? display : data, data);
    header.compression() = compression_named(options.compression);
    header.zipCompressionLevel() = 1; // on noisy floats: 0.1 to 0.4 % larger than 4, a third faster
    Imf::addChromaticities(header, Imf::Chromaticities()); // the default: Rec. 709 and D65
    for (const auto& [name, value] : metadata)
        std::visit(AttributeWriter{header, name}, value);
    return header;
}

/// Describes `pixels` to OpenEXR as three channels, in place. OpenEXR counts from the pixel (0, 0)
/// of the display window, which may lie outside the memory: hence the arithmetic on addresses.
template <typename T>
void add_channels(Imf::Header& header, Imf::FrameBuffer& buffer, const std::string& layer,
                  Imf::PixelType type, const T* pixels) {
    const Imath::Box2i window = header.dataWindow();
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    for (std::size_t c = 0; c < 3; ++c) {
        const std::string name = layer + "RGB"[c];
        header.channels().insert(name, Imf::Channel(type));
        buffer.insert(
            name, Imf::Slice::Make(type, pixels + c, window, 3 * sizeof(T), 3 * sizeof(T) * width));
    }
}

static_assert(sizeof(Rgb) == 3 * sizeof(float));

/// Zip takes 30 ms of one core for 256x256 noisy floats, a third of what a 1 spp render may take
/// from start to end: worth a few threads. The bytes are the same for any number.
int thread_count(const Image& image) {
    constexpr std::size_t worth_threads = std::size_t{1} << 14u;
    if (image.pixels.size() < worth_threads)
        return 0;
    const int threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 8u));
    if (Imf::globalThreadCount() < threads)
        Imf::setGlobalThreadCount(threads);
    return threads;
}

std::string encode(const Image& image, const ExrOptions& options, const Metadata& metadata) {
    Imf::Header header = header_of(image, options, metadata);
    Imf::FrameBuffer buffer;
    std::vector<half> halves;
    if (options.half) {
        halves.reserve(3 * image.pixels.size());
        for (const Rgb& c : image.pixels)
            halves.insert(halves.end(), {half(c.r), half(c.g), half(c.b)});
        add_channels(header, buffer, "", Imf::HALF, halves.data());
    } else {
        add_channels(header, buffer, "", Imf::FLOAT, &image.pixels.data()->r);
    }
    if (!image.variance.empty())
        add_channels(header, buffer, "variance.", Imf::FLOAT, &image.variance.data()->r);
    StringStream stream;
    {
        Imf::OutputFile file(stream, header, thread_count(image));
        file.setFrameBuffer(buffer);
        file.writePixels(image.height);
    } // the destructor writes the table of offsets
    return stream.take();
}

} // namespace

std::string exr_compressions() {
    std::string names;
    for (const NamedCompression& known : known_compressions)
        names += (names.empty() ? "" : ", ") + std::string(known.name);
    return names;
}

void check_exr_compression(const std::string& name) { static_cast<void>(compression_named(name)); }

std::string encode_exr(const Image& image, const ExrOptions& options, const Metadata& metadata) {
    const auto count =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    if (image.width < 1 || image.height < 1 || image.pixels.size() != count ||
        (!image.variance.empty() && image.variance.size() != count))
        throw SceneError(ErrorKind::output, {}, "an image without pixels cannot be written");
    try {
        return encode(image, options, metadata);
    } catch (const SceneError&) {
        throw;
    } catch (const std::exception& error) {
        throw SceneError(ErrorKind::output, {}, std::string("EXR: ") + error.what());
    }
}

} // namespace plumb
