/// \file  The determinism contract at the command line: flags that must not change a bit of the
/// image, by the hash that --stats reports.

#include "tests/accel/intersector_suite.h"
#include "tests/support/run_command.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

#include <unistd.h>

namespace plumb::test {
namespace {

namespace fs = std::filesystem;

class DeterminismCommand : public ::testing::TestWithParam<const char*> {
  protected:
    void SetUp() override {
        folder_ = fs::path(::testing::TempDir()) /
                  ("plumb-bits-" + std::to_string(::getpid()) + "-" + GetParam());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// The image_hash of a run with these flags; empty, and a failure, where there is none.
    [[nodiscard]] std::string hash_with(const std::string& flags) const {
        const CommandOutcome run = run_command(
            "cd '" + folder_.string() + "' && rm -f s.json && " + PLUMB_BINARY_DIR +
            "/bin/renderer -q -D res=24 -D spp=4 --rr-depth 2 --stats s.json -o a.exr " + flags +
            " " + PLUMB_SOURCE_DIR + "/scenes/" + GetParam() + ".xml");
        EXPECT_EQ(run.exit_code, 0) << flags << '\n' << run.output;
        std::ostringstream text;
        text << std::ifstream(folder_ / "s.json").rdbuf();
        const std::string stats = text.str(), key = "\"image_hash\": \"";
        const std::size_t at = stats.find(key);
        if (at == std::string::npos) {
            ADD_FAILURE() << flags << ": no hash in " << stats;
            return {};
        }
        return stats.substr(at + key.size(), stats.find('"', at + key.size()) - at - key.size());
    }

    void expect_same(const std::vector<std::string>& all) const {
        const std::string plain = hash_with("--accel naive --threads 1");
        EXPECT_GE(plain.size(), 8u);
        for (const std::string& flags : all)
            EXPECT_EQ(hash_with(flags), plain) << flags;
    }

    fs::path folder_;
};

TEST_P(DeterminismCommand, HowItIsComputedChangesNoBit) {
    expect_same({"", "--threads 1", "--threads 2", "--threads 5", "--accel sah", "--accel naive",
                 "--build-quality fast", "--build-quality high", "--full-profile", "--variance",
                 "--validate naive", "--time-limit 1h --spp 4"});
}

TEST_P(DeterminismCommand, NoInstructionSetChangesABit) {
    std::vector<std::string> flags;
    for (const Isa isa : isas_here()) // the program refuses what this processor lacks
        for (const char* quality : {"medium", "high"})
            flags.push_back("--isa " + std::string(plumb::name_of(isa)) + " --build-quality " +
                            quality);
    expect_same(flags);
}

TEST_P(DeterminismCommand, WhatIsComputedChangesTheHash) {
    const std::string plain = hash_with("");
    for (const char* flags : {"--seed 1", "--spp 5", "--sampler independent", "--rr none",
                              "-D max_depth=3", "--estimator light", "--hemisphere uniform"})
        EXPECT_NE(hash_with(flags), plain) << flags;
}

INSTANTIATE_TEST_SUITE_P(Scenes, DeterminismCommand,
                         ::testing::Values("cornell-box", "many-lights"), [](const auto& tested) {
                             std::string name = tested.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

} // namespace
} // namespace plumb::test
