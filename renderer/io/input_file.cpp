/// \file  Whole files in memory: open, check the size, read once.
#include "renderer/io/input_file.h"

#include <cerrno>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace plumb {
namespace {

/// Who asks for a file, for messages.
struct InputSource {
    const std::filesystem::path& file;
    ErrorKind kind;
    const std::vector<SourceLocation>& included_from;
};

/// An open file descriptor.
class Descriptor {
  public:
    /// Non-blocking, so that a pipe without a writer does not hang before it is refused.
    explicit Descriptor(const std::filesystem::path& file)
        : fd_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
    ~Descriptor() {
        if (fd_ >= 0)
            ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] int get() const { return fd_; }

  private:
    int fd_;
};

[[noreturn]] void refuse(const InputSource& source, const std::string& what) {
    throw SceneError(source.kind, {source.file.string(), 0, 0}, what, source.included_from);
}

[[noreturn]] void refuse_by_errno(const InputSource& source, const char* action) {
    refuse(source, std::string(action) + ": " + std::generic_category().message(errno));
}

/// Size in bytes of an open file that read_file accepts.
std::size_t checked_size(const Descriptor& descriptor, const InputSource& source,
                         std::uint64_t max_bytes) {
    struct ::stat status {};
    if (descriptor.get() < 0 || ::fstat(descriptor.get(), &status) != 0)
        refuse_by_errno(source, "cannot open");
    if (S_ISDIR(status.st_mode))
        refuse(source, "is a directory (expected a file)");
    if (!S_ISREG(status.st_mode))
        refuse(source, "is a device or a pipe (expected a regular file)");
    const auto size = static_cast<std::uint64_t>(status.st_size);
    if (size > max_bytes)
        refuse(source, "is too large (got " + std::to_string(size) + " bytes, expected at most " +
                           std::to_string(max_bytes) + ")");
    return static_cast<std::size_t>(size);
}

/// Fills `text` from the start of the file; shortens it if the file has shrunk meanwhile.
bool read_all(int fd, std::string& text) {
    std::size_t filled = 0;
    while (filled < text.size()) {
        const ::ssize_t got = ::read(fd, text.data() + filled, text.size() - filled);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return false;
        if (got == 0)
            break;
        filled += static_cast<std::size_t>(got);
    }
    text.resize(filled);
    return true;
}

} // namespace

std::string read_file(const std::filesystem::path& file, ErrorKind kind, std::uint64_t max_bytes,
                      const std::vector<SourceLocation>& included_from) {
    const InputSource source{file, kind, included_from};
    const Descriptor descriptor(file);
    std::string text(checked_size(descriptor, source, max_bytes), '\0');
    if (!read_all(descriptor.get(), text))
        refuse_by_errno(source, "cannot read");
    return text;
}

MappedFile::MappedFile(const std::filesystem::path& file, ErrorKind kind) {
    const std::vector<SourceLocation> nowhere;
    const InputSource source{file, kind, nowhere};
    const Descriptor descriptor(file);
    const std::size_t size = checked_size(descriptor, source, max_input_bytes);
    if (size == 0) // mmap refuses an empty range
        return;
    void* const bytes = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor.get(), 0);
    if (bytes == MAP_FAILED)
        refuse_by_errno(source, "cannot map");
    text_ = {static_cast<const char*>(bytes), size};
}

MappedFile::~MappedFile() {
    if (!text_.empty())
        ::munmap(const_cast<char*>(text_.data()), text_.size());
}

} // namespace plumb
