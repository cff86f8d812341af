/// \file  Whole files in memory: open, check the size, read once.
#include "renderer/io/input_file.h"

#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace plumb {
namespace {

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

std::string system_message(const char* action) {
    return std::string(action) + ": " + std::generic_category().message(errno);
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
    const auto refuse = [&](const std::string& what) {
        throw SceneError(kind, {file.string(), 0, 0}, what, included_from);
    };
    const Descriptor descriptor(file);
    struct ::stat status {};
    if (descriptor.get() < 0 || ::fstat(descriptor.get(), &status) != 0)
        refuse(system_message("cannot open"));
    if (S_ISDIR(status.st_mode))
        refuse("is a directory (expected a file)");
    if (!S_ISREG(status.st_mode))
        refuse("is a device or a pipe (expected a regular file)");
    const auto size = static_cast<std::uint64_t>(status.st_size);
    if (size > max_bytes)
        refuse("is too large (got " + std::to_string(size) + " bytes, expected at most " +
               std::to_string(max_bytes) + ")");
    std::string text(static_cast<std::size_t>(size), '\0');
    if (!read_all(descriptor.get(), text))
        refuse(system_message("cannot read"));
    return text;
}

} // namespace plumb
