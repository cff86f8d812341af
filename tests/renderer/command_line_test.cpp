/// \file  The program as a user meets it: exit codes, messages, files (bad-input.md, command line).

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace plumb::test {
namespace {

namespace fs = std::filesystem;

/// What a run printed (stdout and stderr together) and how it ended.
struct Outcome {
    int exit_code = -1;
    std::string output;
};

class CommandLine : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(::testing::TempDir()) /
                  ("plumb-" + std::to_string(::getpid()) + "-" +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder_);
        write("box.xml", scene("8"));
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// A sphere under a constant sky, `spp` samples a pixel.
    static std::string scene(const std::string& spp) {
        return "<scene version='3.0.0'>\n<default name='spp' value='" + spp + "'/>\n" + R"(
<integrator type="path"><integer name="max_depth" value="4"/></integrator>
<sensor type="perspective"><transform name="to_world">
  <lookat origin="0 0 -4" target="0 0 0" up="0 1 0"/></transform>
  <sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>
  <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="12"/></film>
</sensor>
<shape type="sphere"/>
<emitter type="constant"/>
</scene>)";
    }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
    }
    [[nodiscard]] std::string read(const std::string& name) const {
        std::ostringstream text;
        text << std::ifstream(folder_ / name, std::ios::binary).rdbuf();
        return text.str();
    }
    [[nodiscard]] Outcome renderer(const std::string& arguments,
                                   const std::string& before = "") const {
        const std::string command = "cd '" + folder_.string() + "' && " + before + " " +
                                    PLUMB_BINARY_DIR + "/bin/renderer " + arguments + " 2>&1";
        Outcome run;
        FILE* pipe = ::popen(command.c_str(), "r");
        std::array<char, 4096> buffer{};
        for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
            run.output.append(buffer.data(), n);
        const int status = ::pclose(pipe);
        run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        return run;
    }
    [[nodiscard]] std::size_t file_count() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }

    fs::path folder_;
};

struct BadCall {
    const char* arguments;
    int exit_code;
    const char* fragment;
};

TEST_F(CommandLine, BadCallsSayWhatIsWrongAndWriteNothing) {
    const BadCall calls[] = {
        {"", 2, "scene is required"},
        {"--acel=sah box.xml", 2, "unknown option '--acel=sah' (did you mean '--accel'?)"},
        {"--accel=octree box.xml", 2, "(got 'octree', expected embree, naive, sah)"},
        {"--spp", 2, "--spp"},
        {"--spp 0 box.xml", 2, "(got '0', expected 1 to"},
        {"--spp 1,5 box.xml", 2, "(got '1,5'"},
        {"--threads 0 box.xml", 2, "(got '0', expected 1 to 1024)"},
        {"--threads -3 box.xml", 2, "(got '-3', expected 1 to 1024)"},
        {"--threads 1e9 box.xml", 2, "(got '1e9', expected 1 to 1024)"},
        {"--rr constant:0 box.xml", 2, "(got 'constant:0'"},
        {"--rr constant:nan box.xml", 2, "(got 'constant:nan'"},
        {"--seed -1 box.xml", 2, "(got '-1'"},
        {"--exposure 1e999 -o a.png box.xml", 2, "(got '1e999'"},
        {"-D spp box.xml", 2, "(got 'spp', expected NAME=VALUE)"},
        {"box.xml box.xml", 2, "unexpected argument 'box.xml'"},
        {"''", 2, "scene: empty value"},
        {"--stats '' box.xml", 2, "--stats: empty value"},
        {"-o '' box.xml", 2, "--output: empty value"},
        {"--accel=\x1b[31mred box.xml", 2, "(got '?[31mred', expected"}, // no colours
        {"--accel=embree --triangle-test=moeller-trumbore box.xml", 2, "needs --accel=naive"},
        {"--device=cuda --accel=naive box.xml", 2, "needs --accel=sah"},
        {"--cuda-tree=octree box.xml", 2, "(got 'octree', expected binary, wide)"},
        {"--cuda-schedule=x box.xml", 2, "(got 'x', expected megakernel, persistent, wavefront)"},
        {"--cuda-schedule=persistent --cuda-tree=binary box.xml", 2, "needs --cuda-tree=wide"},
        {"--validate=cuda --device=cuda box.xml", 2, "--validate: needs --device=cpu"},
        {"--validate=cuda --accel=embree box.xml", 2, "not Embree's"},
        {"--validate=cuda --time-limit 1s box.xml", 2, "neither by error nor by time"},
        {"--quiet --explain box.xml", 2, "contradicts"},
        {"--target-error 0 box.xml", 2, "--target-error: bad error (got '0', expected above 0"},
        {"--target-error=-0.1 box.xml", 2, "(got '-0.1', expected above 0 to 1)"},
        {"--target-error nan box.xml", 2, "(got 'nan', expected above 0 to 1)"},
        {"--target-error 1.5 box.xml", 2, "(got '1.5', expected above 0 to 1)"},
        {"--target-error 1% box.xml", 2, "(got '1%', expected above 0 to 1)"},
        {"--target-error 0.1 --spp 3 box.xml", 2, "(got --spp '3', expected at least 4)"},
        {"--target-error 0.1 --device=cuda box.xml", 2, "--target-error: needs --device=cpu"},
        {"--reuse 3 box.xml", 2, "--reuse"},
        {"--reuse 2 --device cuda box.xml", 2, "--reuse: needs --device=cpu"},
        {"--reuse 2 --validate cuda box.xml", 2, "--validate: cuda shares no paths"},
        {"--reuse 4 --target-error 0.1 box.xml", 2, "--reuse: contradicts --target-error"},
        {"--target-error 0.1 --variance box.xml", 2, "--variance: contradicts --target-error"},
        {"--time-limit abc box.xml", 2, "--time-limit: bad time (got 'abc', expected above 0"},
        {"--time-limit 0 box.xml", 2, "(got '0', expected above 0"},
        {"--time-limit=-5s box.xml", 2, "(got '-5s', expected above 0"},
        {"--time-limit s box.xml", 2, "(got 's', expected above 0"},
        {"--time-limit 3d box.xml", 2, "(got '3d', expected above 0"},
        {"--time-limit inf box.xml", 2, "(got 'inf', expected above 0"},
        {"--time-limit 1e300h box.xml", 2, "(got '1e300h', expected above 0"},
        {"--time-limit 1e9m box.xml", 2, "(got '1e9m', expected above 0"},
        {"--time-limit 1m30s box.xml", 2, "(got '1m30s', expected above 0"},
        {"--time-limit 1s --device=cuda box.xml", 2, "--time-limit: needs --device=cpu"},
        {"--view Sepia -o a.png box.xml", 2, "(got 'Sepia', expected one of sRGB"},
        {"-o a.exr -o a.exr box.xml", 2, "a.exr"},
        {"missing.xml", 3, "missing.xml: error: "},
        {"-D spp=0 box.xml", 3, "box.xml:"},
        {"-o missing/a.exr box.xml", 5, "missing"},
        {"-o a.webm box.xml", 5, "(got '.webm', expected one of exr"},
        {"-o . box.xml", 5, ""},
        {"--stats missing/a.json box.xml", 5, "missing"},
    };
    for (const BadCall& call : calls) {
        const Outcome run = renderer(call.arguments);
        EXPECT_EQ(run.exit_code, call.exit_code) << call.arguments << '\n' << run.output;
        EXPECT_NE(run.output.find(call.fragment), std::string::npos) << call.arguments << '\n'
                                                                     << run.output;
        EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
        EXPECT_EQ(file_count(), 1u) << call.arguments;
    }
}

TEST_F(CommandLine, HelpAndVersionAreAnswersNotErrors) {
    const Outcome help = renderer("--help");
    EXPECT_EQ(help.exit_code, 0);
    for (const char* word : {"--accel", "--estimator", "--output", "Exit codes", "Examples"})
        EXPECT_NE(help.output.find(word), std::string::npos) << word;
    EXPECT_EQ(renderer("--version").output, "plumbline " PLUMB_VERSION "\n");
}

TEST_F(CommandLine, WithoutOutputsTheSceneNamesTheFiles) {
    const Outcome run = renderer("box.xml");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_NE(run.output.find("wrote box.exr\nwrote box.png\n"), std::string::npos) << run.output;
    EXPECT_TRUE(fs::exists(folder_ / "box.exr"));
    EXPECT_TRUE(fs::exists(folder_ / "box.png"));
    EXPECT_EQ(file_count(), 3u);
}

TEST_F(CommandLine, QuietPrintsNothingAndStatsHoldTheNumbers) {
    const Outcome run = renderer("-q --spp 3 --threads 1 --stats s.json -o a.exr box.xml");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_EQ(run.output, "");
    const std::string stats = read("s.json");
    for (const char* line : {"\"spp\": 3", "\"samples\": 576", "\"camera\": 576", "\"threads\": 1",
                             "\"accel\": \"sah\"", "\"image_hash\": \""})
        EXPECT_NE(stats.find(line), std::string::npos) << line << '\n' << stats;
}

/// What the run says of its end, in the table and in --stats.
TEST_F(CommandLine, StoppingByErrorOrTimeSaysWhichWasHit) {
    const struct {
        const char *arguments, *stopped_by;
    } calls[] = {
        {"--target-error 0.5", "target-error"},
        {"--target-error 0.5 --time-limit 1h", "target-error"},
        {"--target-error 1e-6 --time-limit 50ms", "time-limit"},
        {"--time-limit 0.05", "time-limit"},
        {"--time-limit 0.05s --variance", "time-limit"},
        {"--target-error 1e-6 --spp 80", "spp"},
        {"--time-limit 1h --spp 5", "spp"},
        {"--target-error 0.5 --validate=naive", "target-error"},
        {"--target-error 0.5 --device=auto", "target-error"},
    };
    for (const auto& call : calls) {
        const std::string arguments = call.arguments;
        const Outcome run = renderer(arguments + " --stats s.json -o a.exr box.xml");
        EXPECT_EQ(run.exit_code, 0) << run.output;
        const std::string table = std::string("stopped by ") + call.stopped_by + ": error ";
        EXPECT_NE(run.output.find(table), std::string::npos) << arguments << '\n' << run.output;
        const std::string stats = read("s.json");
        const std::string json = std::string("\"stopped_by\": \"") + call.stopped_by + "\"";
        EXPECT_NE(stats.find(json), std::string::npos) << arguments << '\n' << stats;
        EXPECT_NE(stats.find("\"reached\": { \"error\": "), std::string::npos) << stats;
    }
    const Outcome plain = renderer("--stats s.json -o a.exr box.xml");
    EXPECT_EQ(plain.output.find("stopped by"), std::string::npos) << plain.output;
    EXPECT_NE(read("s.json").find("\"stopped_by\": \"spp\""), std::string::npos);
    EXPECT_EQ(read("s.json").find("reached"), std::string::npos);
}

TEST_F(CommandLine, ExplainNamesTheContentsAndTheKernel) {
    const Outcome run = renderer("--explain box.xml");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_NE(run.output.find("0 triangles in 0 meshes, 1 spheres"), std::string::npos);
    EXPECT_NE(run.output.find("needs      spheres, environment"), std::string::npos) << run.output;
    EXPECT_NE(run.output.find("profile 'full'"), std::string::npos);
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(CommandLine, ExplainSaysWhatEndsTheSamples) {
    const struct {
        const char* flags;
        const char* expected;
    } cases[] = {
        {"--spp 9", "samples    9 a pixel, "},
        {"--target-error 0.01", "samples    until the error is 1 %, at most 16777216 a pixel, "},
        {"--time-limit 30s --spp 64", "samples    until 30.00 s have passed, at most 64 a pixel, "},
        {"--target-error 0.05 --time-limit 500ms",
         "samples    until the error is 5 % or 500 ms have passed, at most 16777216 a pixel, "},
        {"--time-limit 10", "until 10.00 s have passed"},
        {"--time-limit 0.25s", "until 250 ms have passed"},
        {"--time-limit 2m", "until 2 min 00 s have passed"},
        {"--time-limit 1.5h", "until 90 min 00 s have passed"},
        {"--target-error 1", "until the error is 100 %"},    // the largest
        {"--target-error 0.1 --spp 4", "at most 4 a pixel"}, // the fewest
    };
    for (const auto& c : cases) {
        const Outcome run = renderer(std::string("--explain ") + c.flags + " box.xml");
        EXPECT_EQ(run.exit_code, 0);
        EXPECT_NE(run.output.find(c.expected), std::string::npos) << run.output;
    }
}

TEST_F(CommandLine, AFailedWriteLeavesWhatStoodThere) {
    write("a.exr", "precious");
    const Outcome full = renderer("-D spp=1 -o a.exr box.xml", "ulimit -f 0 &&");
    EXPECT_EQ(full.exit_code, 5) << full.output;
    EXPECT_EQ(read("a.exr"), "precious");
    EXPECT_EQ(file_count(), 2u);
}

TEST_F(CommandLine, LittleMemoryIsAResourceErrorNotACrash) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers reserve more address space than the limit";
#endif
    write("huge.xml", [] {
        std::string text = scene("1");
        text.replace(text.find("value=\"16\""), 10, "value=\"60000\"");
        return text.replace(text.find("value=\"12\""), 10, "value=\"60000\"");
    }());
    const Outcome run = renderer("-o a.exr huge.xml", "ulimit -v 2000000 &&");
    EXPECT_EQ(run.exit_code, 6) << run.output;
    EXPECT_EQ(run.output, "error: out of memory\n");
}

TEST_F(CommandLine, SignalsEndInTheImageSoFarAndTheirExitCode) {
    for (const std::string stop : {"", "--time-limit 1h ", "--target-error 1e-5 "}) {
        const Outcome run = renderer(stop + "--spp 100000000 -q --stats s.json -o a.exr box.xml",
                                     "rm -f a.exr && timeout --preserve-status --signal=TERM 0.5");
        EXPECT_EQ(run.exit_code, 128 + SIGTERM) << run.output;
        EXPECT_TRUE(fs::exists(folder_ / "a.exr"));
        EXPECT_EQ(file_count(), 3u);
        EXPECT_NE(read("s.json").find("\"stopped_by\": \"signal\""), std::string::npos) << stop;
    }
}

TEST_F(CommandLine, WithoutADeviceCudaSaysWhyInOneLineAndWritesNothing) {
    for (const char* flags : {"--device=cuda", "--device=cuda --cuda-tree=wide",
                              "--device=cuda --cuda-schedule=persistent", "--validate=cuda"}) {
        const Outcome run = renderer(std::string(flags) + " box.xml");
        if (run.exit_code == 0)
            GTEST_SKIP() << "there is a device";
        EXPECT_EQ(run.exit_code, 6) << flags << '\n' << run.output;
        EXPECT_EQ(run.output.rfind("error: cuda: ", 0), 0u) << run.output;
        EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
        EXPECT_EQ(file_count(), 1u) << flags;
    }
}

} // namespace
} // namespace plumb::test
