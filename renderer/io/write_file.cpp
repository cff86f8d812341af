#include "renderer/io/write_file.h"

#include "renderer/scene/error.h"

#include <cerrno>
#include <fcntl.h>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace plumb {
namespace {

using std::filesystem::path;

[[noreturn]] void refuse(const path& target, const std::string& what) {
    throw SceneError(ErrorKind::output, {target.string()}, what);
}

[[noreturn]] void refuse_by_errno(const path& target, const std::string& what, int code) {
    refuse(target, what + ": " + std::generic_category().message(code));
}

/// A file open for writing; closed when it goes out of scope.
class OpenFile {
  public:
    explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    ~OpenFile() {
        if (descriptor_ >= 0)
            ::close(descriptor_);
    }
    [[nodiscard]] int get() const { return descriptor_; }
    /// The error of a delayed write, or 0. Not called twice.
    int close() { return ::close(std::exchange(descriptor_, -1)) == 0 ? 0 : errno; }

  private:
    int descriptor_;
};

/// 0 or the error. Goes on after short writes and interrupts.
int write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno != EINTR)
            return errno;
        if (written > 0)
            bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return 0;
}

/// Removes the temporary unless it has become the target.
class Temporary {
  public:
    /// Opens a new file in the target's folder. One that a killed process of the same number (as
    /// containers have) left behind is not touched: another name is tried.
    explicit Temporary(const path& target, mode_t mode) {
        constexpr std::size_t longest_name = 200; // leaves room for the rest within NAME_MAX
        const std::string stem =
            fmt::format(".{}.{}", target.filename().string().substr(0, longest_name), ::getpid());
        for (int attempt = 0; attempt < 100 && descriptor_ < 0; ++attempt) {
            path_ = target.parent_path() /
                    (attempt == 0 ? stem + ".tmp" : fmt::format("{}-{}.tmp", stem, attempt));
            descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
            if (descriptor_ < 0 && errno != EEXIST)
                break;
        }
        if (descriptor_ < 0)
            refuse_by_errno(target, "cannot write into the folder", errno);
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;
    ~Temporary() {
        if (!renamed_)
            ::unlink(path_.c_str());
    }
    [[nodiscard]] int descriptor() const { return descriptor_; }
    /// 0 or the error.
    int rename_to(const path& target) {
        renamed_ = ::rename(path_.c_str(), target.c_str()) == 0;
        return renamed_ ? 0 : errno;
    }

  private:
    path path_;
    int descriptor_ = -1;
    bool renamed_ = false;
};

/// What stands at a path; empty if nothing does.
std::optional<struct stat> status_of(const path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0)
        return std::nullopt;
    return status;
}

/// Where the bytes go in the end: a link is followed, so that the rename does not replace it.
path resolved(const path& target) {
    std::error_code error;
    if (!std::filesystem::is_symlink(target, error))
        return target;
    const path real = std::filesystem::weakly_canonical(target, error);
    return error ? target : real;
}

path folder_of(const path& file) {
    const path folder = file.parent_path();
    return folder.empty() ? path(".") : folder;
}

void write_directly(const path& target, std::string_view bytes) {
    OpenFile file(::open(target.c_str(), O_WRONLY | O_CLOEXEC));
    if (file.get() < 0)
        refuse_by_errno(target, "cannot be written", errno);
    int error = write_all(file.get(), bytes);
    if (error == 0)
        error = file.close();
    if (error != 0)
        refuse_by_errno(target, "cannot be written", error);
}

void replace(const path& target, const path& real, std::string_view bytes,
             const std::optional<struct stat>& before) {
    Temporary temporary(real, 0666);
    OpenFile file(temporary.descriptor());
    int error = write_all(file.get(), bytes);
    if (error == 0 && before)
        static_cast<void>(::fchmod(file.get(), before->st_mode & 0777u));
    // Some file systems cannot flush and say EINVAL: no reason to lose the image.
    if (error == 0 && ::fsync(file.get()) != 0 && errno != EINVAL)
        error = errno;
    const int close_error = file.close();
    if (error == 0)
        error = close_error;
    if (error == 0)
        error = temporary.rename_to(real);
    if (error != 0)
        refuse_by_errno(target, "cannot be written", error);
}

bool can_be_replaced(const struct stat& status) { return S_ISREG(status.st_mode); }

} // namespace

void check_writable(const path& target) {
    if (target.filename().empty())
        refuse(target, "is no file name");
    const path real = resolved(target);
    const auto status = status_of(real);
    if (status && S_ISDIR(status->st_mode))
        refuse(target, "is a directory");
    if (status && ::access(real.c_str(), W_OK) != 0)
        refuse_by_errno(target, "cannot be written", errno);
    if (status && !can_be_replaced(*status))
        return;
    const path folder = folder_of(real);
    const auto folder_status = status_of(folder);
    if (!folder_status)
        refuse_by_errno(target, "the folder '" + folder.string() + "' cannot be used", errno);
    if (!S_ISDIR(folder_status->st_mode))
        refuse(target, "'" + folder.string() + "' is not a directory");
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        refuse_by_errno(target, "cannot write into the folder '" + folder.string() + "'", errno);
}

void atomic_write(const path& target, std::string_view bytes) {
    check_writable(target);
    const path real = resolved(target);
    const auto status = status_of(real);
    if (status && !can_be_replaced(*status))
        write_directly(target, bytes);
    else
        replace(target, real, bytes, status);
}

} // namespace plumb
