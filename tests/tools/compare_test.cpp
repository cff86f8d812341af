/// \file  plumb_compare as a user meets it: exit codes, text, JSON and the picture.
#include "renderer/io/exr_file.h"
#include "renderer/io/read_image.h"
#include "renderer/io/write_file.h"
#include "renderer/io/write_images.h"
#include "tests/support/random.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace plumb {
namespace {

namespace fs = std::filesystem;

struct Outcome {
    int exit_code = -1;
    std::string output; ///< of both streams
    [[nodiscard]] bool says(const std::string& text) const {
        return output.find(text) != std::string::npos;
    }
};

class Compare : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / ("plumb_compare_" + std::to_string(::getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// In the folder of the test.
    [[nodiscard]] Outcome run(const std::string& arguments) const {
        const std::string command = "cd '" + folder_.string() + "' && unset OCIO; '" +
                                    PLUMB_BINARY_DIR "/bin/plumb_compare' " + arguments + " 2>&1";
        Outcome outcome;
        FILE* pipe = popen(command.c_str(), "r");
        if (!pipe)
            return outcome;
        std::array<char, 4096> buffer;
        while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
            outcome.output.append(buffer.data(), n);
        const int status = pclose(pipe);
        outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        return outcome;
    }
    void store(const std::string& name, const Image& image, const Metadata& metadata = {}) const {
        atomic_write(folder_ / name, encode_exr(image, {}, metadata));
    }
    static Image flat(Rgb colour, int width = 8, int height = 8) {
        return {width,
                height,
                width,
                height,
                0,
                0,
                std::vector<Rgb>(static_cast<std::size_t>(width * height), colour),
                {}};
    }
    /// Means of 16 uniform samples of 0 … 2 `mean`, and the variance of one.
    static Image noisy(std::uint64_t seed, float mean = 0.5f) {
        Image image = flat({}, 32, 32);
        test::Random random(seed);
        for (Rgb& c : image.pixels)
            for (int sample = 0; sample < 16; ++sample) {
                const float r = random.uniform(), g = random.uniform();
                c += Rgb{r, g, random.uniform()} * (2 * mean / 16);
            }
        image.variance.assign(image.pixels.size(), Rgb{1, 1, 1} * (4 * mean * mean / 12));
        return image;
    }

    fs::path folder_;
};

TEST_F(Compare, EqualImagesPassEveryThreshold) {
    store("a.exr", flat({0.5f, 0.25f, 1}));
    const Outcome o = run("a.exr a.exr --same-bits --max-mse 0 --max-abs 0 --max-mean-error 0");
    EXPECT_EQ(o.exit_code, 0) << o.output;
    EXPECT_TRUE(o.says("MSE           0\n")) << o.output;
    EXPECT_TRUE(o.says("PSNR          inf dB"));
}

TEST_F(Compare, EveryThresholdFailsWhenItIsExceededAndOnlyThen) {
    store("a.exr", flat({1.5f, 1, 1})); // one of three channels differs by 0.5
    store("b.exr", flat({1, 1, 1}));
    // MSE 0.25 / 3; relMSE that over 1.01; PSNR 10 log10(12).
    const std::array<std::array<const char*, 3>, 6> cases{{
        {"--max-mse", "0.0834", "0.0833"},
        {"--max-relmse", "0.0826", "0.0825"},
        {"--max-abs", "0.5", "0.499"},
        {"--min-psnr", "10.79", "10.80"},
        {"--max-mean-error", "0.5", "0.499"},
        {"--max-mean-z", "inf", "1e9"},
    }};
    for (const auto& [option, within, beyond] : cases) {
        EXPECT_EQ(run(std::string("a.exr b.exr ") + option + " " + within).exit_code, 0) << option;
        const Outcome o = run(std::string("a.exr b.exr ") + option + " " + beyond);
        EXPECT_EQ(o.exit_code, 1) << option;
        EXPECT_TRUE(o.says("beyond the threshold")) << o.output;
    }
    EXPECT_EQ(run("a.exr b.exr --same-bits").exit_code, 1);
    EXPECT_EQ(run("a.exr b.exr").exit_code, 0);
}

TEST_F(Compare, NanInOneImageOnlyFailsWithoutAnyThreshold) {
    Image image = flat({1, 1, 1});
    store("b.exr", image);
    image.pixels[9].g = std::nanf("");
    store("a.exr", image);
    const Outcome o = run("a.exr b.exr");
    EXPECT_EQ(o.exit_code, 1);
    EXPECT_TRUE(o.says("1 values are NaN or infinite in one image only")) << o.output;
}

TEST_F(Compare, ZTestTakesVarianceAndSamplesFromTheFiles) {
    store("a.exr", noisy(1), {{"spp", 16}});
    store("b.exr", noisy(2), {{"spp", 16}});
    store("biased.exr", noisy(3, 0.52f), {{"spp", 16}});
    const Outcome good = run("a.exr b.exr");
    EXPECT_EQ(good.exit_code, 0) << good.output;
    EXPECT_TRUE(good.says("z-test of pixels   passed"));
    // 4 % of bias: standard error of the mean 0.5 / sqrt(3 * 16) * sqrt(2) / 32, z about 6.
    const Outcome bad = run("biased.exr b.exr");
    EXPECT_EQ(bad.exit_code, 1);
    EXPECT_TRUE(bad.says("z-test of the mean failed")) << bad.output;
    EXPECT_EQ(run("biased.exr b.exr --no-z-test").exit_code, 0);
    // Claimed to have far more samples than it has, the noise itself fails …
    EXPECT_EQ(run("a.exr b.exr --spp-a 4096 --spp-b inf").exit_code, 1);
    // … unless failures of that share are allowed.
    EXPECT_FALSE(run("a.exr b.exr --spp-a 4096 --spp-b inf --outliers 1").says("values fail"));
}

TEST_F(Compare, VarianceAndSamplesCanBeGivenByHand) {
    Image a = noisy(1), b = noisy(2), variance = a;
    variance.pixels = a.variance;
    a.variance.clear();
    b.variance.clear();
    variance.variance.clear();
    store("a.exr", a);
    store("b.exr", b);
    store("v.exr", variance);
    EXPECT_FALSE(run("a.exr b.exr").says("z-test of pixels"));
    const Outcome o = run("a.exr b.exr --variance-b v.exr --spp-a 16 --spp-b 16");
    EXPECT_TRUE(o.says("z-test of pixels   passed")) << o.output;
    store("small.exr", flat({1, 1, 1}));
    EXPECT_EQ(run("a.exr b.exr --variance-a small.exr --spp-a 1 --spp-b 1").exit_code, 4);
}

TEST_F(Compare, JsonHoldsTheSameNumbersAndTheVerdict) {
    store("a.exr", flat({1.5f, 1, 1}));
    store("b.exr", flat({1, 1, 1}));
    const Outcome o = run("a.exr b.exr --json --max-mse 0.01");
    EXPECT_EQ(o.exit_code, 1);
    EXPECT_EQ(o.output.substr(0, 20), "{\"mse\":0.0833333333,");
    EXPECT_TRUE(o.says("\"mean_ratio\":[1.5,1,1]")) << o.output;
    EXPECT_TRUE(o.says("\"within\":false}\n"));
    EXPECT_TRUE(run("b.exr b.exr --json").says("\"psnr_db\":null"));
}

TEST_F(Compare, PictureIsRedWhereAIsBrighterAndBlueWhereBIs) {
    Image a = flat({0.5f, 0.5f, 0.5f}), b = a;
    a.pixels[0].g = 0.75f;
    b.pixels[1].b = 0.6f;
    store("a.exr", a);
    store("b.exr", b);
    EXPECT_EQ(run("a.exr b.exr -o d.png --scale 0.25").exit_code, 0);
    const Image picture = read_image(folder_ / "d.png", PixelDecoding::srgb);
    EXPECT_EQ(picture.pixels[0], (Rgb{1, 0, 0}));
    EXPECT_NEAR(picture.pixels[1].b, 0.4f, 0.005f);
    EXPECT_EQ(picture.pixels[1].r, 0);
    EXPECT_EQ(picture.pixels[2], Rgb{});
    EXPECT_EQ(run("a.exr b.exr -o d.pfm").exit_code, 0);
    EXPECT_FLOAT_EQ(read_image(folder_ / "d.pfm").pixels[0].g, 0.25f);
    EXPECT_FLOAT_EQ(read_image(folder_ / "d.pfm").pixels[1].b, -0.1f);
}

TEST_F(Compare, OtherFormatsAreComparedByTheirStoredValues) {
    OutputOptions options;
    options.files = {folder_ / "a.png", folder_ / "a.ppm"};
    write_images(flat({0.2f, 0.4f, 0.9f}), options, {});
    EXPECT_EQ(run("a.png a.ppm --same-bits").exit_code, 0);
}

TEST_F(Compare, UsageErrorsAre2AndUnreadableImages4) {
    store("a.exr", flat({1, 1, 1}));
    store("b.exr", flat({1, 1, 1}, 4, 4));
    for (const char* arguments : {"", "a.exr", "a.exr a.exr a.exr", "a.exr a.exr --max-mse x",
                                  "a.exr a.exr --alpha 2", "a.exr a.exr --scale -1"})
        EXPECT_EQ(run(arguments).exit_code, 2) << arguments;
    const Outcome unknown = run("a.exr a.exr --max-mee 1");
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_TRUE(unknown.says("did you mean '--max-mse'?")) << unknown.output;
    EXPECT_EQ(run("a.exr missing.exr").exit_code, 4);
    EXPECT_EQ(run("a.exr a.gif").exit_code, 4);
    const Outcome sizes = run("a.exr b.exr");
    EXPECT_EQ(sizes.exit_code, 4);
    EXPECT_TRUE(sizes.says("differ in size: 8x8 and 4x4"));
    EXPECT_EQ(run("a.exr a.exr -o missing/d.png").exit_code, 5);
    EXPECT_EQ(run("a.exr a.exr -o d.bmp").exit_code, 5);
    EXPECT_EQ(run("--help").exit_code, 0);
    EXPECT_TRUE(run("--version").says("Plumbline"));
}

} // namespace
} // namespace plumb
