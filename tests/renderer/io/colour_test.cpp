/// \file  Display codes of the built-in views against the formulas of their transfer functions.
#include "renderer/io/colour.h"

#include "renderer/scene/error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>

namespace plumb {
namespace {

/// The codes of one row of pixels.
std::vector<std::uint8_t> codes(const std::vector<Rgb>& row, const std::string& view,
                                float exposure = 0) {
    const int width = static_cast<int>(row.size());
    return display_pixels({width, 1, width, 1, 0, 0, row, {}}, {view, exposure, {}});
}

int grey_code(float value, const std::string& view, float exposure = 0) {
    const auto c = codes({{value, value, value}}, view, exposure);
    EXPECT_EQ(c[0], c[1]);
    EXPECT_EQ(c[1], c[2]);
    return c[0];
}

std::string refusal(const DisplayOptions& options) {
    try {
        check_display(options);
    } catch (const SceneError& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        return error.what();
    }
    return "";
}

/// IEC 61966-2-1 in double precision.
double srgb_encoded(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// Keeps the tests independent of the caller's configuration.
class Colour : public testing::Test {
  protected:
    void SetUp() override { unsetenv("OCIO"); }
    void TearDown() override { unsetenv("OCIO"); }
};

TEST_F(Colour, GreyOf18PercentIs118UnderSrgbAnd91UnderTheWriteUpsGamma) {
    EXPECT_EQ(grey_code(0.18f, "sRGB"), 118);     // 255 * 0.46135 = 117.6
    EXPECT_EQ(grey_code(0.18f, "Gamma 0.6"), 91); // 255 * 0.18^0.6 = 91.1
    EXPECT_EQ(grey_code(0.18f, "Raw"), 46);       // 45.9
}

TEST_F(Colour, SrgbIsTheDefaultView) {
    const std::vector<Rgb> row{{0.1f, 0.2f, 0.7f}};
    EXPECT_EQ(codes(row, ""), codes(row, "sRGB"));
    EXPECT_NE(codes(row, ""), codes(row, "Raw"));
}

TEST_F(Colour, BlackIsZeroAndWhiteIs255InEveryDirectView) {
    for (const char* view : {"sRGB", "Gamma 0.6", "Raw"}) {
        EXPECT_EQ(grey_code(0, view), 0) << view;
        EXPECT_EQ(grey_code(1, view), 255) << view;
        EXPECT_EQ(grey_code(7, view), 255) << view;
        EXPECT_EQ(grey_code(-7, view), 0) << view;
    }
}

TEST_F(Colour, All256CodesComeBackThroughSrgb) {
    std::vector<Rgb> row;
    for (int code = 0; code < 256; ++code) {
        const float linear = srgb_to_linear(static_cast<float>(code) / 255);
        row.push_back({linear, linear, linear});
    }
    const auto back = codes(row, "sRGB");
    for (std::size_t code = 0; code < 256; ++code)
        EXPECT_EQ(back[3 * code], code);
}

TEST_F(Colour, SrgbMatchesTheStandardEverywhere) {
    std::vector<Rgb> row;
    for (int i = 0; i <= 20000; ++i)
        row.push_back({static_cast<float>(i) / 20000, 0, 1});
    const auto got = codes(row, "sRGB");
    for (std::size_t i = 0; i < row.size(); ++i) {
        const double exact = 255 * srgb_encoded(double{row[i].r});
        // Rounded to the nearest code; 0.501 leaves room where the exact value is a tie.
        EXPECT_LE(std::abs(got[3 * i] - exact), 0.501) << row[i].r;
        EXPECT_EQ(got[3 * i + 1], 0);
        EXPECT_EQ(got[3 * i + 2], 255);
    }
}

TEST_F(Colour, Gamma06MatchesItsPower) {
    std::vector<Rgb> row;
    for (int i = 0; i <= 5000; ++i)
        row.push_back({static_cast<float>(i) / 5000, 2, -1});
    const auto got = codes(row, "Gamma 0.6");
    for (std::size_t i = 0; i < row.size(); ++i)
        EXPECT_LE(std::abs(got[3 * i] - 255 * std::pow(double{row[i].r}, 0.6)), 0.501);
}

TEST_F(Colour, SrgbToLinearInvertsTheStandardAndIsOdd) {
    for (int i = 0; i <= 1000; ++i) {
        const double s = i / 1000.0;
        EXPECT_NEAR(srgb_encoded(double{srgb_to_linear(static_cast<float>(s))}), s, 3e-6);
    }
    EXPECT_EQ(srgb_to_linear(-0.5f), -srgb_to_linear(0.5f));
}

TEST_F(Colour, ExposureMultipliesByPowersOfTwoBeforeTheView) {
    EXPECT_EQ(grey_code(0.045f, "sRGB", 2), 118);
    EXPECT_EQ(grey_code(0.72f, "sRGB", -2), 118);
    EXPECT_EQ(grey_code(0.36f, "Gamma 0.6", -1), 91);
}

TEST_F(Colour, NanIsBlackAndInfinityIsTheEndOfTheScale) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const char* view : {"sRGB", "Gamma 0.6", "Raw"}) {
        const auto c = codes({{nan, infinity, -infinity}, {1, nan, 0}}, view);
        EXPECT_EQ(c, (std::vector<std::uint8_t>{0, 255, 0, 255, 0, 0})) << view;
    }
    const auto aces = codes({{infinity, infinity, infinity}, {nan, nan, nan}}, "ACES SDR");
    EXPECT_GE(aces[0], 250);
    EXPECT_LE(aces[3], 2);
}

TEST_F(Colour, AcesKeepsGreysNeutralAndRising) {
    std::vector<Rgb> row;
    for (int stop = -8; stop <= 8; ++stop) {
        const float v = 0.18f * std::exp2(static_cast<float>(stop));
        row.push_back({v, v, v});
    }
    const auto c = codes(row, "ACES SDR");
    int before = -1;
    for (std::size_t i = 0; i < row.size(); ++i) {
        const auto [low, high] = std::minmax({c[3 * i], c[3 * i + 1], c[3 * i + 2]});
        EXPECT_LE(high - low, 1) << row[i].r;
        EXPECT_GE(c[3 * i + 1], before) << row[i].r;
        before = c[3 * i + 1];
    }
    // ACES 1 puts 18 % grey at 4.8 cd/m² of 48: 10 % of the display, encoded 0.349, code 89.
    EXPECT_NEAR(grey_code(0.18f, "ACES SDR"), 89, 2);
}

TEST_F(Colour, UnknownViewNamesTheKnownOnes) {
    const std::string text = refusal({"Filmic", 0, {}});
    for (const char* part : {"got 'Filmic'", "sRGB", "ACES SDR", "Gamma 0.6", "Raw"})
        EXPECT_NE(text.find(part), std::string::npos) << part;
    for (const char* view : {"", "sRGB", "ACES SDR", "Gamma 0.6", "Raw"})
        EXPECT_EQ(refusal({view, 0, {}}), "");
}

TEST_F(Colour, ExposureMustBeFinite) {
    EXPECT_NE(refusal({"", std::numeric_limits<float>::quiet_NaN(), {}}), "");
    EXPECT_NE(refusal({"", std::numeric_limits<float>::infinity(), {}}), "");
}

TEST_F(Colour, ConfigurationComesFromTheOptionThenTheEnvironment) {
    const std::string missing = testing::TempDir() + "plumb_missing.ocio";
    EXPECT_NE(refusal({"", 0, missing}).find("plumb_missing.ocio"), std::string::npos);
    setenv("OCIO", missing.c_str(), 1);
    EXPECT_NE(refusal({"", 0, {}}).find("plumb_missing.ocio"), std::string::npos);
    // The option wins over the environment, and the file in scenes/ is a whole configuration.
    EXPECT_EQ(refusal({"Gamma 0.6", 0, PLUMB_SOURCE_DIR "/scenes/display.ocio"}), "");
    setenv("OCIO", "", 1);
    EXPECT_EQ(refusal({"", 0, {}}), "");
}

TEST_F(Colour, ConfigurationWithAcesInterchangeGetsAnExactConversion) {
    // Its scene_linear is AP0: taken for Rec. 709, a pure red would come out as it is.
    const std::string file = testing::TempDir() + "plumb_aces.ocio";
    std::ofstream(file) << "ocio_profile_version: 2\n"
                           "roles: {aces_interchange: AP0, scene_linear: AP0, default: AP0}\n"
                           "file_rules: [!<Rule> {name: Default, colorspace: default}]\n"
                           "displays: {D: [!<View> {name: V, colorspace: AP0}]}\n"
                           "colorspaces: [!<ColorSpace> {name: AP0}]\n";
    const auto c = display_pixels({1, 1, 1, 1, 0, 0, {{1, 0, 0}}, {}}, {"", 0, file});
    // Rec. 709 red in ACES2065-1 (Bradford): 0.4396, 0.0898, 0.0175.
    EXPECT_EQ(c, (std::vector<std::uint8_t>{112, 23, 4}));
}

} // namespace
} // namespace plumb
