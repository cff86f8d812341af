/// \file  Scene files of a test, in a folder of their own.
#pragma once

#include "renderer/io/load_scene.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <unistd.h>

namespace plumb::test {

/// A fixture with an empty folder, removed at the end.
class SceneFiles : public ::testing::Test {
  protected:
    using Parameters = std::vector<std::pair<std::string, std::string>>;

    void SetUp() override {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  ("plumb_" + std::to_string(::getpid()) + "_" + info->name());
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

    std::filesystem::path write(const std::string& name, std::string_view content) const {
        const std::filesystem::path file = folder_ / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << content;
        return file;
    }

    [[nodiscard]] Scene load(std::string_view content, const Parameters& parameters = {},
                             bool lenient = false) const {
        return load_scene({write("scene.xml", content), parameters, lenient});
    }

    /// The message of the SceneError that loading gives, without the folder's name; says so where
    /// there is none. `kind` is checked.
    [[nodiscard]] std::string error_of(const LoadOptions& options,
                                       ErrorKind kind = ErrorKind::scene) const {
        try {
            static_cast<void>(load_scene(options));
        } catch (const SceneError& error) {
            EXPECT_EQ(error.kind(), kind) << error.what();
            return without_folder(error.what());
        }
        return "(loaded without an error)";
    }
    [[nodiscard]] std::string error(std::string_view content,
                                    ErrorKind kind = ErrorKind::scene) const {
        return error_of({write("scene.xml", content), {}, false}, kind);
    }

    [[nodiscard]] std::string without_folder(std::string text) const {
        const std::string prefix = folder_.string() + "/";
        for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix))
            text.erase(at, prefix.size());
        return text;
    }

  private:
    std::filesystem::path folder_;
};

/// `body` from line 2 of a scene on.
inline std::string in_scene(std::string_view body) {
    return "<scene version=\"3.0.0\">\n" + std::string(body) + "\n</scene>\n";
}

} // namespace plumb::test
