/// \file  Whole files: what is read, and what is refused with which message.
#include "renderer/io/input_file.h"
#include "renderer/io/text_position.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sys/stat.h>
#include <unistd.h>

namespace plumb {
namespace {

/// ctest runs the tests as processes side by side.
std::string scratch(const std::string& name) {
    return testing::TempDir() + "input_file_" + std::to_string(::getpid()) + name;
}

/// The message with which both ways to read refuse `file`.
std::string refusal(const std::string& file) {
    std::string messages[2];
    try {
        static_cast<void>(read_file(file, ErrorKind::scene));
    } catch (const SceneError& error) {
        messages[0] = error.what();
        EXPECT_EQ(error.exit_code(), 3);
    }
    try {
        const MappedFile mapped(file, ErrorKind::mesh);
    } catch (const SceneError& error) {
        messages[1] = error.what();
        EXPECT_EQ(error.exit_code(), 4);
    }
    EXPECT_EQ(messages[0], messages[1]);
    return messages[0];
}

TEST(InputFile, ReadsBytesAsTheyAre) {
    const std::string bytes("a\0b\r\n\xff", 6), file = scratch("bytes");
    std::ofstream(file, std::ios::binary) << bytes;
    EXPECT_EQ(read_file(file, ErrorKind::scene), bytes);
    EXPECT_EQ(MappedFile(file, ErrorKind::mesh).text(), bytes);
    std::ofstream(file, std::ios::trunc).close();
    EXPECT_EQ(read_file(file, ErrorKind::scene), "");
    EXPECT_EQ(MappedFile(file, ErrorKind::mesh).text(), "");
    ::unlink(file.c_str());
}

TEST(InputFile, RefusesWhatIsNoReadableRegularFile) {
    const std::string missing = scratch("missing");
    EXPECT_EQ(refusal(missing), missing + ": error: cannot open: No such file or directory");
    EXPECT_EQ(refusal(testing::TempDir()),
              testing::TempDir() + ": error: is a directory (expected a file)");
    EXPECT_EQ(refusal("/dev/zero"),
              "/dev/zero: error: is a device or a pipe (expected a regular file)");
    const std::string pipe = scratch("pipe");
    ::unlink(pipe.c_str());
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(refusal(pipe), pipe + ": error: is a device or a pipe (expected a regular file)");
    ::unlink(pipe.c_str());
}

TEST(InputFile, RefusesAnUnreadableFile) {
    if (::geteuid() == 0)
        GTEST_SKIP() << "root reads everything";
    const std::string file = scratch("unreadable");
    std::ofstream(file) << "x";
    ::chmod(file.c_str(), 0);
    EXPECT_EQ(refusal(file), file + ": error: cannot open: Permission denied");
    ::unlink(file.c_str());
}

TEST(InputFile, ChecksTheSizeBeforeItReadsAndNamesTheIncludingFile) {
    const std::string file = scratch("large");
    std::ofstream(file) << "x";
    ASSERT_EQ(::truncate(file.c_str(), off_t{1} << 40), 0); // sparse: takes no space
    try {
        static_cast<void>(read_file(file, ErrorKind::scene, 1000, {{"outer.xml", 3, 5}}));
        FAIL() << "was read";
    } catch (const SceneError& error) {
        EXPECT_EQ(error.what(), file +
                                    ": error: is too large (got 1099511627776 bytes, expected at "
                                    "most 1000)\n  included from outer.xml:3:5");
    }
    EXPECT_NE(refusal(file), "");
    ::unlink(file.c_str());
}

TEST(TextPosition, CountsLinesAndColumnsFromOne) {
    const std::string_view text = "ab\n\ncd";
    const struct {
        std::size_t offset;
        int line, column;
    } rows[] = {{0, 1, 1}, {1, 1, 2}, {2, 1, 3}, {3, 2, 1}, {4, 3, 1}, {6, 3, 3}};
    for (const auto& row : rows) {
        const SourceLocation at = locate("f", text, row.offset);
        EXPECT_EQ(at.line, row.line) << row.offset;
        EXPECT_EQ(at.column, row.column) << row.offset;
    }
}

TEST(TextPosition, QuotesOnOneShortLine) {
    EXPECT_EQ(printable("a\n\xc3\x7f"), "a???");
    EXPECT_EQ(printable(std::string(41, 'x')), std::string(40, 'x') + "...");
}

} // namespace
} // namespace plumb
