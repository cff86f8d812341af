#include "renderer/io/exr_file.h"

#include "renderer/io/input_file.h"
#include "renderer/scene/error.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <stdexcept>
#include <string_view>

namespace plumb {
namespace {

constexpr int largest_side = 65536;

/// A file that is in memory already, so that its size is known and cannot change.
class BytesStream final : public Imf::IStream {
  public:
    explicit BytesStream(std::string_view bytes) : Imf::IStream("data"), bytes_(bytes) {}
    bool read(char target[], int count) override {
        const auto n = static_cast<std::uint64_t>(count);
        if (position_ > bytes_.size() || n > bytes_.size() - position_)
            throw std::runtime_error("the file is truncated");
        std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(position_), n, target);
        position_ += n;
        return position_ < bytes_.size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override { position_ = position; }

  private:
    std::string_view bytes_;
    std::uint64_t position_ = 0;
};

/// OpenEXR allocates tables for the size that a header claims: limit that first.
void limit_sizes() {
    static const bool done = [] {
        Imf::Header::setMaxImageSize(largest_side, largest_side);
        return true;
    }();
    static_cast<void>(done);
}

/// Throws where the file is too short for its own header. No lossless method of the format packs
/// tighter than zlib's 1 : 1032, and every chunk of at most 256 lines has an entry of 16 bytes.
void check_size(const Imf::Header& header, std::uint64_t file_bytes) {
    const Imath::Box2i window = header.dataWindow();
    const auto width = static_cast<std::uint64_t>(window.max.x - window.min.x + 1);
    const auto height = static_cast<std::uint64_t>(window.max.y - window.min.y + 1);
    std::uint64_t channels = 0;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        ++channels;
    const std::uint64_t values = width * height * std::max(channels, std::uint64_t{1});
    const bool lossless = header.compression() <= Imf::ZIP_COMPRESSION;
    const std::uint64_t packed = lossless ? 1100 : 16384;
    if (values * 2 / packed > file_bytes)
        throw std::runtime_error("the file is too short for an image of " + std::to_string(width) +
                                 "x" + std::to_string(height) + " (" + std::to_string(file_bytes) +
                                 " bytes)");
}

/// The three channels of a layer, or one grey channel three times; empty if the file has neither.
std::array<std::string, 3> channel_names(const Imf::ChannelList& channels,
                                         const std::string& layer) {
    const std::string r = layer + "R", g = layer + "G", b = layer + "B", y = layer + "Y";
    if (channels.findChannel(r) && channels.findChannel(g) && channels.findChannel(b))
        return {r, g, b};
    const bool chroma = channels.findChannel("RY") || channels.findChannel("BY");
    if (channels.findChannel(y) && !chroma)
        return {y, y, y};
    return {};
}

std::string all_names(const Imf::ChannelList& channels) {
    std::string names;
    for (auto c = channels.begin(); c != channels.end(); ++c)
        names += (names.empty() ? "" : " ") + std::string(c.name());
    return names.empty() ? "none" : names;
}

/// Points `buffer` at pixels for one layer. A grey channel can be read only once: into red.
void add_channels(Imf::FrameBuffer& buffer, const Imath::Box2i& window,
                  const std::array<std::string, 3>& names, std::vector<Rgb>& pixels) {
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    const std::array<float*, 3> first{&pixels.data()->r, &pixels.data()->g, &pixels.data()->b};
    for (std::size_t c = 0; c < (names[0] == names[1] ? 1u : 3u); ++c)
        buffer.insert(names[c], Imf::Slice::Make(Imf::FLOAT, first[c], window, sizeof(Rgb),
                                                 sizeof(Rgb) * width));
}

void spread_grey(const std::array<std::string, 3>& names, std::vector<Rgb>& pixels) {
    if (names[0] != names[1])
        return;
    for (Rgb& c : pixels)
        c = {c.r, c.r, c.r};
}

Metadata metadata_of(const Imf::Header& header) {
    Metadata metadata;
    for (auto a = header.begin(); a != header.end(); ++a) {
        const Imf::Attribute& attribute = a.attribute();
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute))
            metadata.emplace_back(a.name(), text->value());
        else if (const auto* real = dynamic_cast<const Imf::FloatAttribute*>(&attribute))
            metadata.emplace_back(a.name(), real->value());
        else if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(&attribute))
            metadata.emplace_back(a.name(), integer->value());
    }
    return metadata;
}

ExrContents read(std::string_view bytes) {
    limit_sizes();
    BytesStream stream(bytes);
    Imf::InputFile file(stream, 0);
    const Imf::Header& header = file.header();
    check_size(header, bytes.size());
    const auto names = channel_names(header.channels(), "");
    if (names[0].empty())
        throw std::runtime_error("no colour in the EXR (got the channels '" +
                                 all_names(header.channels()) + "', expected R, G, B or Y)");
    const auto variance_names = channel_names(header.channels(), "variance.");
    const Imath::Box2i window = header.dataWindow(), display = header.displayWindow();
    const Imath::V2i size = window.size() + Imath::V2i(1, 1);
    const Imath::V2i full = display.size() + Imath::V2i(1, 1);
    const auto count = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);

    ExrContents contents;
    Image& image = contents.image;
    image = {size.x,
             size.y,
             full.x,
             full.y,
             window.min.x - display.min.x,
             window.min.y - display.min.y,
             std::vector<Rgb>(count),
             {}};
    Imf::FrameBuffer buffer;
    add_channels(buffer, window, names, image.pixels);
    if (!variance_names[0].empty()) {
        image.variance.resize(count);
        add_channels(buffer, window, variance_names, image.variance);
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    spread_grey(names, image.pixels);
    spread_grey(variance_names, image.variance);
    contents.metadata = metadata_of(header);
    return contents;
}

} // namespace

ExrContents read_exr(const std::filesystem::path& path) {
    const std::string bytes = read_file(path, ErrorKind::mesh);
    try {
        return read(bytes);
    } catch (const std::exception& broken) {
        throw SceneError(ErrorKind::mesh, {path.string()},
                         std::string("not a readable EXR: ") + broken.what());
    }
}

} // namespace plumb
