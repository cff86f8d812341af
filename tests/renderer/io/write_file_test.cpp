/// \file  Files appear whole or not at all, whatever goes wrong.
#include "renderer/io/write_file.h"

#include "renderer/scene/error.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <sys/resource.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace plumb {
namespace {

namespace fs = std::filesystem;

/// A fresh folder for each test.
class AtomicWrite : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / ("plumb_write_" + std::to_string(::getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    [[nodiscard]] fs::path in_folder(const std::string& name) const { return folder_ / name; }
    static void put(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
    static std::string text_of(const fs::path& file) {
        std::ostringstream text;
        text << std::ifstream(file, std::ios::binary).rdbuf();
        return text.str();
    }
    [[nodiscard]] std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    static std::string refusal(const fs::path& target, const std::string& bytes) {
        try {
            atomic_write(target, bytes);
        } catch (const SceneError& error) {
            EXPECT_EQ(error.kind(), ErrorKind::output);
            EXPECT_EQ(std::string(error.what()).find(target.string()), 0u);
            return error.what();
        }
        return "";
    }

    fs::path folder_;
};

/// No file may grow beyond `bytes`, as on a disk that is full.
class FullDisk {
  public:
    explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limited{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limited);
    }
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;
    ~FullDisk() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

  private:
    rlimit before_{};
    void (*handler_)(int);
};

TEST_F(AtomicWrite, WritesEveryByteAndLeavesNothingElse) {
    const std::string bytes("a\0b\nc", 5);
    atomic_write(in_folder("new.bin"), bytes);
    EXPECT_EQ(text_of(in_folder("new.bin")), bytes);
    atomic_write(in_folder("new.bin"), "shorter than before, or not");
    EXPECT_EQ(text_of(in_folder("new.bin")), "shorter than before, or not");
    EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicWrite, FullDiskLeavesTheOldFileAndNoTemporary) {
    put(in_folder("image.exr"), "old");
    std::string message;
    {
        const FullDisk disk(1000);
        message = refusal(in_folder("image.exr"), std::string(5000, 'x'));
    }
    EXPECT_NE(message.find("File too large"), std::string::npos) << message;
    EXPECT_EQ(text_of(in_folder("image.exr")), "old");
    EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicWrite, DirectoryAsTargetIsRefused) {
    fs::create_directories(in_folder("folder.exr"));
    EXPECT_NE(refusal(in_folder("folder.exr"), "x").find("is a directory"), std::string::npos);
    EXPECT_NE(refusal(in_folder(""), "x"), "");
    EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicWrite, MissingFolderAndFileAsFolderAreRefused) {
    EXPECT_NE(refusal(in_folder("missing/x.exr"), "x").find("No such file"), std::string::npos);
    put(in_folder("file"), "old");
    EXPECT_NE(refusal(in_folder("file") / "x.exr", "x"), "");
    EXPECT_EQ(text_of(in_folder("file")), "old");
}

TEST_F(AtomicWrite, ReadOnlyFolderAndFileAreRefused) {
    if (::geteuid() == 0)
        GTEST_SKIP() << "root may write everywhere";
    put(in_folder("kept.exr"), "old");
    fs::permissions(in_folder("kept.exr"), fs::perms::owner_read);
    EXPECT_NE(refusal(in_folder("kept.exr"), "x").find("Permission denied"), std::string::npos);
    fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
    const std::string message = refusal(in_folder("new.exr"), "x");
    fs::permissions(folder_, fs::perms::owner_all);
    EXPECT_NE(message.find("Permission denied"), std::string::npos);
    EXPECT_EQ(text_of(in_folder("kept.exr")), "old");
}

TEST_F(AtomicWrite, DevicesAreWrittenDirectlyAndTheirErrorsReported) {
    EXPECT_NE(refusal("/dev/full", "x").find("No space left"), std::string::npos);
    EXPECT_EQ(refusal("/dev/null", "x"), "");
    struct stat status {};
    ASSERT_EQ(::stat("/dev/null", &status), 0);
    EXPECT_TRUE(S_ISCHR(status.st_mode)); // it has not been replaced by a file
    fs::create_symlink("/dev/full", in_folder("full.exr"));
    EXPECT_NE(refusal(in_folder("full.exr"), "x").find("No space left"), std::string::npos);
    EXPECT_TRUE(fs::is_symlink(in_folder("full.exr")));
}

TEST_F(AtomicWrite, SymbolicLinkStaysALinkToTheNewContent) {
    put(in_folder("real.exr"), "old");
    fs::create_symlink("real.exr", in_folder("link.exr"));
    atomic_write(in_folder("link.exr"), "new");
    EXPECT_TRUE(fs::is_symlink(in_folder("link.exr")));
    EXPECT_EQ(text_of(in_folder("real.exr")), "new");
}

TEST_F(AtomicWrite, StaleTemporaryOfTheSameProcessNumberIsNoObstacle) {
    const std::string stale = ".image.exr." + std::to_string(::getpid()) + ".tmp";
    put(in_folder(stale), "left by a crash");
    atomic_write(in_folder("image.exr"), "new");
    EXPECT_EQ(text_of(in_folder("image.exr")), "new");
    EXPECT_EQ(text_of(in_folder(stale)), "left by a crash");
    EXPECT_EQ(entries(), 2u);
}

TEST_F(AtomicWrite, TwoWritersLeaveOneWholeFile) {
    const auto many = [&](char letter) {
        for (int i = 0; i < 50; ++i)
            atomic_write(in_folder("image.exr"), std::string(100000, letter));
    };
    std::thread other(many, 'a');
    many('b');
    other.join();
    const std::string text = text_of(in_folder("image.exr"));
    EXPECT_EQ(text, std::string(100000, text.at(0)));
    EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicWrite, PermissionsOfAReplacedFileAreKept) {
    put(in_folder("image.exr"), "old");
    fs::permissions(in_folder("image.exr"), fs::perms::owner_read | fs::perms::owner_write);
    atomic_write(in_folder("image.exr"), "new");
    EXPECT_EQ(fs::status(in_folder("image.exr")).permissions(),
              fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(AtomicWrite, NamesOfTheLargestLengthWork) {
    const std::string name(255, 'n');
    atomic_write(in_folder(name), "x");
    EXPECT_EQ(text_of(in_folder(name)), "x");
}

TEST_F(AtomicWrite, CheckWritesNothing) {
    EXPECT_NO_THROW(check_writable(in_folder("new.exr")));
    EXPECT_EQ(entries(), 0u);
    EXPECT_THROW(check_writable(in_folder("missing/new.exr")), SceneError);
    EXPECT_THROW(check_writable(folder_), SceneError);
}

} // namespace
} // namespace plumb
