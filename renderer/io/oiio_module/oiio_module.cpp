/// \file  The OpenImageIO module: bytes to pixels and back. The only file that sees OpenImageIO.
///
/// Files are encoded into memory and written by the renderer, because OpenImageIO 2.4 reports
/// success for a PNG on a full disk.
#include "renderer/io/oiio_module/oiio_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace plumb {
namespace {

/// A file in memory that can be read while it is written, as libtiff does when it places its
/// directories; OpenImageIO's own IOVecOutput cannot.
class MemoryFile final : public OIIO::Filesystem::IOProxy {
  public:
    MemoryFile() : IOProxy("memory", Write) {}
    const char* proxytype() const override { return "memory"; }
    std::size_t size() const override { return bytes_.size(); }
    std::size_t write(const void* from, std::size_t count) override {
        return advance(pwrite(from, count, m_pos));
    }
    std::size_t read(void* to, std::size_t count) override {
        return advance(pread(to, count, m_pos));
    }
    std::size_t pwrite(const void* from, std::size_t count, std::int64_t offset) override {
        if (offset < 0)
            return 0;
        const auto begin = static_cast<std::size_t>(offset);
        bytes_.resize(std::max(bytes_.size(), begin + count));
        std::copy_n(static_cast<const unsigned char*>(from), count,
                    bytes_.begin() + static_cast<std::ptrdiff_t>(begin));
        return count;
    }
    std::size_t pread(void* to, std::size_t count, std::int64_t offset) override {
        if (offset < 0 || static_cast<std::size_t>(offset) >= bytes_.size())
            return 0;
        const std::size_t n = std::min(count, bytes_.size() - static_cast<std::size_t>(offset));
        std::copy_n(bytes_.begin() + offset, n, static_cast<unsigned char*>(to));
        return n;
    }
    [[nodiscard]] const std::vector<unsigned char>& bytes() const { return bytes_; }

  private:
    std::size_t advance(std::size_t count) {
        m_pos += static_cast<std::int64_t>(count);
        return count;
    }
    std::vector<unsigned char> bytes_;
};

[[noreturn]] void fail(const std::string& reason) {
    throw std::runtime_error(reason.empty() ? "OpenImageIO gives no reason" : reason);
}

/// `file` keeps the reason until it is asked.
template <typename File> void require(bool worked, const File& file) {
    if (!worked)
        fail(file.geterror());
}

OIIO::ImageSpec spec_of(const OiioEncodeRequest& request) {
    OIIO::ImageSpec spec(request.width, request.height, 3,
                         request.floats ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    for (std::size_t i = 0; i < request.attribute_count; ++i)
        if (*request.attributes[i].value != '\0') // an empty one aborts 2.4's JPEG writer
            spec.attribute(request.attributes[i].name, request.attributes[i].value);
    spec.attribute("oiio:ColorSpace", request.floats ? "Linear" : "sRGB");
    spec.attribute("CompressionQuality", 95); // JPEG, with colour at full resolution
    spec.attribute("jpeg:subsampling", "4:4:4");
    return spec;
}

void encode(const OiioEncodeRequest& request, OiioSink sink, void* context) {
    MemoryFile file;
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(request.format);
    if (!output)
        fail(OIIO::geterror());
    require(output->set_ioproxy(&file), *output);
    require(output->open(std::string("memory.") + request.format, spec_of(request)), *output);
    const void* pixels = request.bytes;
    if (request.floats)
        pixels = request.floats;
    const OIIO::TypeDesc type = request.floats ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8;
    // What counts is what the calls return: with a TIFF, 2.4 also leaves a message about Exif data
    // that the image does not have.
    require(output->write_image(type, pixels), *output);
    require(output->close(), *output);
    static_cast<void>(output->geterror()); // else reported on stderr by the destructor
    sink(context, file.bytes().data(), file.bytes().size());
}

void decode(const OiioDecodeRequest& request, OiioAllocate allocate, void* context) {
    OIIO::Filesystem::IOMemReader file(const_cast<void*>(request.data), request.size);
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(request.format);
    if (!input)
        fail(OIIO::geterror());
    require(input->set_ioproxy(&file), *input);
    OIIO::ImageSpec wish, spec;
    wish.attribute("oiio:UnassociatedAlpha", 1); // colours as stored, not multiplied by alpha
    require(input->open(std::string("memory.") + request.format, spec, wish), *input);
    const bool floating = spec.format.is_floating_point();
    float* pixels = allocate(context, {spec.width, spec.height, spec.nchannels, floating});
    if (!pixels)
        fail("refused");
    require(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels), *input);
    // Of a truncated TIFF or JPEG, 2.4 says that it was read, and leaves the reason behind.
    const std::string problem = input->geterror();
    if (!problem.empty())
        fail(problem);
    input->close();
}

void describe(OiioError& error, const char* text) {
    std::strncpy(error.text, text, sizeof(error.text) - 1);
    error.text[sizeof(error.text) - 1] = '\0';
    std::replace(std::begin(error.text), std::end(error.text), '\n', ' ');
}

template <typename Action> bool attempt(OiioError* error, Action action) {
    try {
        OIIO::attribute("threads", 1); // small images: no pool of threads
        action();
        return true;
    } catch (const std::exception& caught) {
        describe(*error, caught.what());
    } catch (...) {
        describe(*error, "unknown exception");
    }
    return false;
}

} // namespace

extern "C" {

int plumb_oiio_version() { return oiio_module_version; }

bool plumb_oiio_encode(const OiioEncodeRequest* request, OiioSink sink, void* context,
                       OiioError* error) {
    return attempt(error, [&] { encode(*request, sink, context); });
}

bool plumb_oiio_decode(const OiioDecodeRequest* request, OiioAllocate allocate, void* context,
                       OiioError* error) {
    return attempt(error, [&] { decode(*request, allocate, context); });
}

} // extern "C"

} // namespace plumb
