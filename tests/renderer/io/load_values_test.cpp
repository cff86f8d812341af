/// \file  Every way to write a value.

#include "renderer/io/colour_value.h"
#include "tests/renderer/io/load_scene_files.h"

#include <algorithm>

namespace plumb::test {
namespace {

class LoadValues : public SceneFiles {
  protected:
    /// The reflectance of a diffuse BSDF whose one property is `element`.
    [[nodiscard]] Rgb reflectance(const std::string& element) const {
        const Scene scene = load(in_scene("<bsdf type='diffuse'>" + element + "</bsdf>"));
        return scene.materials.at(0).reflectance;
    }
    [[nodiscard]] Vec3 center(const std::string& element) const {
        return load(in_scene("<shape type='sphere'>" + element + "</shape>")).spheres.at(0).center;
    }
};

TEST_F(LoadValues, LinearColoursAreThreeNumbersOrOne) {
    const Rgb expected{0.1f, 0.25f, 1};
    EXPECT_EQ(reflectance("<rgb name='reflectance' value='0.1 0.25 1'/>"), expected);
    EXPECT_EQ(reflectance("<rgb name='reflectance' value='0.1, 0.25, 1'/>"), expected);
    EXPECT_EQ(reflectance("<rgb name='reflectance' value='0.1,0.25,1'/>"), expected);
    EXPECT_EQ(reflectance("<rgb name='reflectance' value='\n\t1e-1 ,\n+.25\t100e-2 '/>"), expected);
    EXPECT_EQ(reflectance("<color name='reflectance' value='0.1 0.25 1'/>"), expected);
    const Rgb grey{0.25f, 0.25f, 0.25f};
    EXPECT_EQ(reflectance("<rgb name='reflectance' value='0.25'/>"), grey);
    EXPECT_EQ(reflectance("<spectrum name='reflectance' value='0.25'/>"), grey);
    EXPECT_EQ(reflectance("<float name='reflectance' value='0.25'/>"), grey);
}

TEST_F(LoadValues, EncodedColoursAreDecodedBySrgb) {
    // IEC 61966-2-1: 0.5 -> 0.214041, 0x80 / 255 -> 0.215861, 0x0A / 255 -> 0.003035 (linear part).
    const Rgb srgb = reflectance("<srgb name='reflectance' value='0.5 1 0'/>");
    EXPECT_NEAR(srgb.r, 0.214041, 1e-6);
    EXPECT_EQ(srgb.g, 1);
    EXPECT_EQ(srgb.b, 0);
    for (const std::string element : {"<rgb", "<srgb"}) {
        const Rgb hex = reflectance(element + " name='reflectance' value='#80FF0a'/>");
        EXPECT_NEAR(hex.r, 0.215861, 1e-6);
        EXPECT_EQ(hex.g, 1);
        EXPECT_NEAR(hex.b, 0.003035, 1e-6);
    }
}

TEST_F(LoadValues, TheSrgbCurveIsContinuousAtItsJoint) {
    EXPECT_NEAR(srgb_to_linear(0.04045f), srgb_to_linear(0.0404501f), 1e-6);
    EXPECT_NEAR(srgb_to_linear(0.04045f), 0.04045 / 12.92, 1e-7);
    EXPECT_EQ(srgb_to_linear(1), 1);
    EXPECT_EQ(srgb_to_linear(-0.5f), -srgb_to_linear(0.5f));
}

TEST_F(LoadValues, PointsAreCoordinatesOrOneValue) {
    const Vec3 expected{1, -2, 0.5f};
    EXPECT_EQ(center("<point name='center' x='1' y='-2' z='.5'/>"), expected);
    EXPECT_EQ(center("<point name='center' value='1, -2, 0.5'/>"), expected);
    EXPECT_EQ(center("<vector name='center' value='1 -2 0.5'/>"), expected);
    EXPECT_EQ(center("<point name='center' z='5'/>"), (Vec3{0, 0, 5}));
    EXPECT_EQ(center("<point name='center' value='3'/>"), (Vec3{3, 3, 3}));
}

TEST_F(LoadValues, NumbersMayStandInWhiteSpaceAndIntegersForFloats) {
    const auto radius = [&](const std::string& element) {
        return load(in_scene("<shape type='sphere'>" + element + "</shape>")).spheres[0].radius;
    };
    EXPECT_EQ(radius("<float name='radius' value=' 2.5 '/>"), 2.5f);
    EXPECT_EQ(radius("<integer name='radius' value='2'/>"), 2);
    EXPECT_EQ(radius("<float name='radius' value='+1e-3'/>"), 1e-3f);
}

TEST_F(LoadValues, EntitiesAndCharacterReferencesAreResolved) {
    const Scene scene =
        load(in_scene("<shape type='cube' id='a&lt;&amp;&gt;&quot;&apos;&#65;&#x42;'/>"));
    EXPECT_EQ(scene.meshes.at(0).name, "a<&>\"'AB");
}

TEST_F(LoadValues, ByteOrderMarksAndUtf16AreUnderstood) {
    const std::string text = in_scene("<shape type='cube' id='caf\xC3\xA9'/>");
    EXPECT_EQ(load("\xEF\xBB\xBF" + text).meshes.at(0).name, "caf\xC3\xA9");
    for (const bool big_endian : {false, true}) {
        std::string wide = big_endian ? "\xFE\xFF" : "\xFF\xFE";
        const auto put = [&](unsigned code) {
            const auto high = static_cast<char>(code >> 8), low = static_cast<char>(code & 0xFFu);
            wide += big_endian ? high : low;
            wide += big_endian ? low : high;
        };
        for (const char c : in_scene("<shape type='cube' id='~'/>"))
            if (c == '~') { // e acute, euro, U+1F600 as a surrogate pair
                for (const unsigned code : {0xE9u, 0x20ACu, 0xD83Du, 0xDE00u})
                    put(code);
            } else {
                put(static_cast<unsigned char>(c));
            }
        EXPECT_EQ(load(wide).meshes.at(0).name, "\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80");
    }
}

TEST_F(LoadValues, CommentsInstructionsAndCrlfChangeNothing) {
    const Scene scene = load("<?xml version='1.0'?>\r\n<!-- <shape type='none'/> -- -->\r\n"
                             "<scene version='2.1.0'>\r\n<?tool x?><!---->\r\n<shape type = 'cube'"
                             "\r\n id=\"c\"  ></shape\r\n>\r\n</scene>\r\n<!-- end -->\r\n");
    EXPECT_EQ(scene.meshes.at(0).name, "c");
}

TEST_F(LoadValues, DefaultsGiveWayToTheCommandLine) {
    const std::string text =
        in_scene(R"(<default name="res" value="64"/><default name="k" value="hdr"/>
<default name="film" value="film"/><default name="res" value="1"/>
<sensor type="perspective"><film type="$k-$film"><integer name="width" value="$res"/></film></sensor>
)");
    EXPECT_NE(error(text).find("unknown plugin 'hdr-film'"), std::string::npos);
    const std::string good =
        in_scene(R"(<default name="res" value="64"/><default name="k" value="hdrfilm"/>
<default name="res" value="1"/><default name="copy" value="$res"/>
<sensor type="perspective"><film type="$k"><integer name="width" value="$res"/>
<integer name="height" value="1$copy"/></film></sensor>)");
    const Scene scene = load(good);
    EXPECT_EQ(scene.film.width, 64);
    EXPECT_EQ(scene.film.height, 164);
    const Scene changed = load(good, {{"res", "12"}, {"none", "1"}});
    EXPECT_EQ(changed.film.width, 12);
    EXPECT_EQ(changed.film.height, 112);
    const auto unused =
        std::count_if(changed.warnings.begin(), changed.warnings.end(), [](const std::string& w) {
            return w.find("-D none has no effect") != std::string::npos;
        });
    EXPECT_EQ(unused, 1);
    EXPECT_EQ(
        std::count_if(changed.warnings.begin(), changed.warnings.end(),
                      [](const std::string& w) { return w.find("-D res") != std::string::npos; }),
        0);
    // Errors in a value that came from a parameter stand where the parameter stands.
    EXPECT_EQ(error_of({write("scene.xml", good), {{"res", "x"}}, false}),
              "scene.xml:4:73: error: bad value of 'width' (got 'x', expected an integer from 1 to "
              "65536)");
}

} // namespace
} // namespace plumb::test
