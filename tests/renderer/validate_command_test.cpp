/// \file  --validate as a user meets it: the table, the exit code, the replay file.

#include "accel/validate/run_replay.h"
#include "tests/support/shared_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

namespace plumb::test {
namespace {

namespace fs = std::filesystem;

struct Outcome {
    int exit_code = -1;
    std::string output; ///< stdout and stderr
};

class ValidateCommand : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(::testing::TempDir()) /
                  ("plumb-" + std::to_string(::getpid()) + "-" +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    [[nodiscard]] Outcome renderer(const std::string& arguments) const {
        const std::string command = "cd '" + folder_.string() +
                                    "' && " PLUMB_BINARY_DIR "/bin/renderer -o a.pfm " + arguments +
                                    " 2>&1";
        Outcome run;
        FILE* pipe = ::popen(command.c_str(), "r");
        std::array<char, 4096> buffer{};
        for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
            run.output.append(buffer.data(), n);
        const int status = ::pclose(pipe);
        run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        return run;
    }
    [[nodiscard]] std::string read(const std::string& name) const {
        std::ostringstream text;
        text << std::ifstream(folder_ / name, std::ios::binary).rdbuf();
        return text.str();
    }
    [[nodiscard]] bool exists(const std::string& name) const { return fs::exists(folder_ / name); }

    static std::string scene(const std::string& name) {
        return PLUMB_SOURCE_DIR "/scenes/" + name + ".xml";
    }

    fs::path folder_;
};

/// The first number after `key`; -1 without it.
long number_after(const std::string& text, const std::string& key) {
    const std::size_t at = text.find(key);
    return at == std::string::npos ? -1 : std::stol(text.substr(at + key.size()));
}

std::string hash_in(const std::string& stats) {
    const std::size_t at = stats.find("\"image_hash\"");
    return at == std::string::npos ? "no hash" : stats.substr(at, 36);
}

TEST_F(ValidateCommand, TheImageIsTheSameAndTheTableCountsEveryRay) {
    for (const std::string name : {"cornell-box", "sphere-light"}) {
        const std::string arguments = "-D res=64 --spp 4 --threads 2 " + scene(name);
        ASSERT_EQ(renderer("--stats plain.json " + arguments).exit_code, 0);
        for (const std::string kind : {"embree", "naive"}) {
            const Outcome run = renderer("--stats s.json --validate=" + kind + " " + arguments);
            EXPECT_EQ(run.exit_code, 0) << run.output;
            EXPECT_NE(run.output.find("validation of sah against " + kind), std::string::npos);
            EXPECT_NE(run.output.find("\n  unexplained: 0\n"), std::string::npos) << run.output;
            EXPECT_FALSE(exists("validate.replay"));
            const std::string stats = read("s.json"), plain = read("plain.json");
            EXPECT_EQ(hash_in(stats), hash_in(plain)) << name;
            // The render's own count of rays, and the validation's.
            const std::size_t validation = stats.find("\"validation\": {");
            ASSERT_NE(validation, std::string::npos) << stats;
            EXPECT_EQ(plain.find("\"validation\""), std::string::npos);
            for (const std::string ray : {"camera", "bounce", "shadow", "total"}) {
                const std::string key = "\"" + ray + "\": ";
                EXPECT_GT(number_after(plain, key), 1000);
                EXPECT_EQ(number_after(stats.substr(validation), key), number_after(plain, key));
            }
            const long equal = number_after(stats, "\"equal\": { \"count\": ");
            const long total = number_after(plain, "\"total\": ");
            EXPECT_EQ(equal == total, kind == "naive") << equal << " of " << total;
            EXPECT_GT(equal, total / 4);
        }
    }
}

TEST_F(ValidateCommand, WhatIsUnexplainedEndsInExitCode1AndAFileThatReproducesIt) {
    // Möller–Trumbore loses digits on the slivers of a round vase: t is off by more than rounding.
    const std::string defective =
        "--triangle-test=moeller-trumbore --validate=embree --max-depth 1 "
        "--spp 8 --stats s.json " +
        scene("white-room");
    const Outcome run = renderer(defective);
    EXPECT_EQ(run.exit_code, 1) << run.output;
    EXPECT_NE(run.output.find("inexact (sah wrong): camera ray, film ("), std::string::npos);
    EXPECT_NE(run.output.find("wrote validate.replay\n"), std::string::npos) << run.output;
    const long unexplained = number_after(run.output, "unexplained: ");
    EXPECT_GT(unexplained, 3);
    EXPECT_EQ(number_after(read("s.json"), "\"unexplained\": "), unexplained);
    const Replay replay = parse_replay(read("validate.replay"));
    EXPECT_EQ(replay.rays.size(), static_cast<std::size_t>(unexplained));
    EXPECT_EQ(replay.triangle_test, TriangleTest::moeller_trumbore);
    EXPECT_EQ(replay.scene, scene("white-room"));
    std::ostringstream out;
    const ReplayOutcome outcome = run_replay(replay, out);
    EXPECT_EQ(outcome.reproduced, replay.rays.size()) << out.str();
    EXPECT_EQ(outcome.unexplained, replay.rays.size()) << out.str();

    const Outcome quiet = renderer("--quiet --replay-file other.replay " + defective);
    EXPECT_EQ(quiet.exit_code, 1);
    EXPECT_EQ(quiet.output, "error: validation: " + std::to_string(unexplained) +
                                " rays on which sah and embree disagree are unexplained "
                                "(other.replay)\n");
    EXPECT_EQ(read("other.replay"), read("validate.replay"));
}

TEST_F(ValidateCommand, ReplayAllKeepsWhatIsExplainedToo) {
    const std::string arguments = "--validate=embree -D res=64 --spp 2 " + scene("many-lights");
    const Outcome run = renderer("--replay-all --replay-file all.replay " + arguments);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    const Replay replay = parse_replay(read("all.replay"));
    EXPECT_GT(replay.rays.size(), 20u);
    for (const Disagreement& d : replay.rays)
        EXPECT_TRUE(is_explained(d.verdict.agreement));
    std::ostringstream out;
    EXPECT_EQ(run_replay(replay, out).reproduced, replay.rays.size()) << out.str();
}

struct BadCall {
    const char* arguments;
    int exit_code;
    const char* fragment;
};

TEST_F(ValidateCommand, ContradictionsAreRefused) {
    const BadCall calls[] = {
        {"--validate=sah", 2, "compares sah with itself"},
        {"--accel=embree --validate=embree", 2, "compares embree with itself"},
        {"--validate=octree", 2, "(got 'octree', expected embree, naive, sah, cuda)"},
        {"--validate=embree --device=cuda", 2, "--validate: needs --device=cpu"},
        {"--replay-file a.replay", 2, "--replay-file: needs --validate"},
        {"--replay-all", 2, "--replay-all: needs --validate"},
        {"--validate=embree --replay-file missing/a.replay", 5, "missing"},
    };
    for (const BadCall& call : calls) {
        const Outcome run = renderer(call.arguments + (" " + scene("cornell-box")));
        EXPECT_EQ(run.exit_code, call.exit_code) << call.arguments << '\n' << run.output;
        EXPECT_NE(run.output.find(call.fragment), std::string::npos) << run.output;
        EXPECT_TRUE(fs::is_empty(folder_)) << call.arguments;
    }
}

TEST_F(ValidateCommand, ARealStaircaseHasNothingUnexplained) {
    const auto found = unpacked_scene(PLUMB_SOURCE_DIR "/../shared/scenes", "staircase2",
                                      PLUMB_BINARY_DIR "/shared-scenes");
    if (!found)
        GTEST_SKIP() << "no archive of the scene 'staircase2' beside the project";
    const Outcome run = renderer("--validate=embree --lenient --spp 1 --max-depth 2 '" +
                                 (*found / "scene_v0.5.xml").string() + "'");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_GT(number_after(run.output, "validation of sah against embree: "), 1000000);
}

} // namespace
} // namespace plumb::test
