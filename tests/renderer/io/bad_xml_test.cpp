/// \file  Every kind of bad scene file: what is said, and at which line and column.

#include "tests/renderer/io/bad_xml.h"

#include <ctime>

namespace plumb::test {
namespace {

TEST_F(BadXml, FilesThatCannotBeReadAreRefused) {
    EXPECT_EQ(error_of({folder() / "none.xml", {}, false}),
              "none.xml: error: cannot open: No such file or directory");
    std::filesystem::create_directory(folder() / "folder.xml");
    EXPECT_EQ(error_of({folder() / "folder.xml", {}, false}),
              "folder.xml: error: is a directory (expected a file)");
    if (::geteuid() == 0)
        return; // root reads everything
    std::filesystem::permissions(write("secret.xml", in_scene("")), std::filesystem::perms::none);
    EXPECT_EQ(error_of({folder() / "secret.xml", {}, false}),
              "secret.xml: error: cannot open: Permission denied");
}

TEST_F(BadXml, TextThatIsNoXmlIsRefused) {
    using namespace std::string_literals;
    expect_refused({
        {"", "1:1: error: no XML element in the file (expected <scene"},
        {" \n\t\n", "1:1: error: no XML element in the file"},
        {"<!-- nothing -->", "1:1: error: no XML element in the file"},
        {"<scene>\n a\0b</scene>"s, "2:3: error: NUL byte in XML"},
        {"<scene>\x01</scene>", "1:8: error: control character in XML (got 0x01)"},
        {"<scene id=\"\xC3(\"/>", "1:12: error: bad UTF-8 (got byte 0xc3)"},
        {"<scene id=\"\xED\xA0\x80\"/>", "1:12: error: bad UTF-8 (got byte 0xed)"},
        {"<scene id=\"\xC0\xAF\"/>", "1:12: error: bad UTF-8 (got byte 0xc0)"},
        {"<scene id=\"\xF5\x80\x80\x80\"/>", "1:12: error: bad UTF-8 (got byte 0xf5)"},
        {"<scene id=\"\xE2\x82", "1:12: error: bad UTF-8 (got byte 0xe2)"},
        {"v 0 0 0\nf 1 2 3\n", "1:1: error: text between elements (got 'v 0 0 0', expected '<')"},
        {"<\0s\0/\0>\0"s, "1:2: error: NUL byte in XML (binary, or UTF-16 without its mark?)"},
        {"\xFF\xFE<\0s"s, " error: UTF-16 text of odd length (got 5 bytes)"},
        {"\xFF\xFE\x00\xDC"s, " error: bad UTF-16 (got an unpaired surrogate at byte 2)"},
    });
}

TEST_F(BadXml, BrokenMarkupIsRefusedAtItsPlace) {
    expect_refused({
        {"<scene version=\"3.0.0\">\n<shape type=\"sph",
         "2:17: error: unexpected end of the file (expected </shape> for line 2:1)"},
        {"<scene version=\"3.0.0\">\n<shape type=\"cube\"/>\n",
         "3:1: error: unexpected end of the file (expected </scene> for line 1:1)"},
        {"<scene", "1:7: error: unexpected end of the file"},
        {"<", "1:2: error: unexpected end of the file"},
        {"<scene><!-- a -- >", "1:8: error: comment without an end (expected '-->')"},
        {"<?xml version='1.0'", "1:1: error: processing instruction without an end"},
        {"<scene>\n <shape>\n</scene>",
         "3:1: error: mismatched tags (got </scene>, expected </shape> for line 2:2)"},
        {"<scene></Scene>", "1:8: error: mismatched tags (got </Scene>, expected </scene>"},
        {"</scene>", "1:1: error: closing tag without an opening one (got </scene>)"},
        {"<scene version=\"3.0.0\"/>\n<scene/>",
         "2:1: error: second root element (got <scene>, expected one)"},
        {"<scene version='3.0.0'\n version='2.0.0'/>",
         "2:2: error: attribute 'version' given twice"},
        {"<!DOCTYPE scene [<!ENTITY a \"lol\">]>\n<scene>&a;</scene>",
         "1:1: error: a DOCTYPE is refused"},
        {"<?xml version='1.0'?><!DOCTYPE scene SYSTEM \"file:///etc/passwd\"><scene/>",
         "1:22: error: a DOCTYPE is refused"},
        {"<scene><![CDATA[x]]></scene>", "1:8: error: a CDATA section or declaration is refused"},
        {"<scene id='a&nbsp;b'/>", "1:13: error: undefined entity (got '&nbsp;'"},
        {"<scene id='a&amp'/>", "1:13: error: undefined entity (got '&amp'"},
        {"<scene id='a & b'/>", "1:14: error: undefined entity (got '& b'"},
        {"<scene id='&#0;'/>", "1:12: error: undefined entity (got '&#0;'"},
        {"<scene id='&#xD800;'/>", "1:12: error: undefined entity (got '&#xD800;'"},
        {"<scene id='&#x110000;'/>", "1:12: error: undefined entity (got '&#x110000;'"},
        {"<scene>\n text</scene>", "2:2: error: text between elements (got 'text', expected '<')"},
        {"<scene version=3/>", "1:16: error: value of 'version' without quotes (got '3'"},
        {"<scene a='1'b='2'/>", "1:13: error: bad XML (got 'b', expected a space, '/>' or '>')"},
        {"<scene version/>", "1:15: error: bad XML (got '/', expected '=')"},
        {"<1scene/>", "1:2: error: bad XML (got '1', expected an element name)"},
        {"<scene a='1\n<shape b='/>", "2:1: error: '<' in the value of 'a'"},
    });
}

TEST_F(BadXml, HugeInputsAreRefusedQuickly) {
    std::string nested = "<scene>", attributes = "<scene", many = "<scene>";
    for (int i = 0; i < 100000; ++i)
        nested += "<bsdf>";
    for (int i = 0; i < 1000; ++i)
        attributes += " a" + std::to_string(i) + "=''";
    for (int i = 0; i < 1000001; ++i)
        many += "<a/>";
    const std::clock_t start = std::clock();
    expect_refused({
        {nested, "1:386: error: elements nested too deeply (expected at most 64)"},
        {attributes + "/>", "1:446: error: too many attributes (expected at most 64)"},
        {many + "</scene>", "1:4000004: error: too many elements (expected at most 1000000)"},
        {"<scene id=\"" + std::string(20'000'000, 'a') + "\"/>",
         "1:12: error: value of 'id' too long (got 20000000 bytes, expected at most 1048576)"},
    });
    // Seconds of CPU time; they take a hundredth of this, the margin is for sanitizers.
    EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 10);
}

TEST_F(BadXml, ParametersCannotGrowWithoutEnd) {
    std::string scene = "<default name='a0' value='lolololololololol'/>";
    for (int i = 0; i < 12; ++i) {
        std::string ten;
        for (int k = 0; k < 10; ++k)
            ten += "$a" + std::to_string(i);
        scene += "\n<default name='a" + std::to_string(i + 1) + "' value='" + ten + "'/>";
    }
    expect_refused_in_scene(
        {{scene, "7:27: error: value too long after putting in parameters (expected at most"}});
}

TEST_F(BadXml, BadRootsAndVersionsAreRefused) {
    expect_refused({
        {"<scenes version='3.0.0'/>", "1:1: error: unknown root element (got <scenes>, expected"},
        {"<scene version='0.3.0'/>", "1:17: error: unsupported scene version (got '0.3.0'"},
        {"<scene version='4.0.0'/>", "1:17: error: unsupported scene version (got '4.0.0'"},
        {"<scene version='three'/>", "1:17: error: unsupported scene version (got 'three'"},
        {"<scene version=''/>", "1:8: error: unsupported scene version (got ''"},
        {"<scene versoin='3.0.0'/>",
         "1:17: error: unknown attribute 'versoin' of <scene> (did you mean 'version'?)"},
    });
}

TEST_F(BadXml, UnknownNamesAreRefusedWithTheNearest) {
    expect_refused_in_scene({
        {"<shap type='cube'/>", "2:1: error: unknown element <shap> in <scene> (did you mean"},
        {"<shape type='cubes'/>", "2:14: error: unknown plugin 'cubes' (shape) (did you mean "
                                  "'cube'?) (supported: obj, ply, sphere"},
        {"<bsdf type='difuse'/>",
         "2:13: error: unknown plugin 'difuse' (bsdf) (did you mean 'diffuse'?)"},
        {"<shape/>", "2:1: error: missing attribute 'type' of <shape>"},
        {"<shape type='sphere'><float name='raduis' value='1'/></shape>",
         "2:35: error: unknown property 'raduis' of shape 'sphere' (did you mean 'radius'?)"},
        {"<integrator type='path'><integer name='maxDept' value='1'/></integrator>",
         "2:40: error: unknown property 'max_dept' of integrator 'path' (did you mean "
         "'max_depth'?)"},
        {"<shape type='sphere'><flaot name='radius' value='1'/></shape>",
         "2:22: error: unknown element <flaot> in shape 'sphere' (did you mean 'float'?)"},
        {"<shape type='sphere' ids='a'/>", "2:27: error: unknown attribute 'ids' of <shape>"},
        {"<shape type='sphere'><float value='1'/></shape>",
         "2:22: error: missing attribute 'name' of <float>"},
        {"<shape type='sphere'><float name='radius'/></shape>",
         "2:22: error: missing attribute 'value' of <float>"},
        {"<shape type='obj'/>", "2:1: error: missing property 'filename' of shape 'obj'"},
        {"<shape type='cube'><transform name='to_world'><rotated x='1'/></transform></shape>",
         "2:47: error: unknown operation in <transform> (got <rotated>, expected translate"},
        {"<shape type='sphere'><float name='radius' value='1'><a/></float></shape>",
         "2:53: error: <a> inside <float>"},
    });
}

TEST_F(BadXml, ThingsGivenTwiceAreRefused) {
    expect_refused_in_scene({
        {"<shape type='sphere'>\n<float name='radius' value='1'/>\n<float name='radius' "
         "value='1'/></shape>",
         "4:14: error: property 'radius' of shape 'sphere' given twice (first at "},
        {"<integrator type='path'><integer name='maxDepth' value='1'/>\n"
         "<integer name='max_depth' value='1'/></integrator>",
         "3:16: error: property 'max_depth' of integrator 'path' given twice"},
        {"<bsdf type='diffuse' id='a'/>\n<bsdf type='diffuse' id='a'/>",
         "3:26: error: id 'a' given twice (first at "},
        {"<integrator type='path'/>\n<integrator type='path'/>", "3:1: error: second integrator"},
        {"<emitter type='constant'/>\n<emitter type='constant'/>",
         "3:1: error: second environment emitter"},
        {"<shape type='cube'><bsdf type='diffuse'/><bsdf type='diffuse'/></shape>",
         "2:1: error: shape with two bsdfs"},
        {"<shape type='cube'><emitter type='area'/><emitter type='area'/></shape>",
         "2:1: error: shape with two emitters"},
        {"<sensor type='perspective'><film type='hdrfilm'/>\n<film type='hdrfilm'/></sensor>",
         "3:1: error: second <film> in one sensor"},
        {"<bsdf type='diffuse' id='a'/><alias id='a' as='a'/>", "2:48: error: id 'a' given twice"},
    });
}

TEST_F(BadXml, BadReferencesAreRefused) {
    expect_refused_in_scene({
        {"<bsdf type='diffuse' id='white'/>\n<shape type='cube'><ref id='whitte'/></shape>",
         "3:29: error: reference to nothing (got 'whitte', expected the id of an element) (did "
         "you mean 'white'?)"},
        {"<shape type='cube'><ref/></shape>", "2:20: error: missing attribute 'id' of <ref>"},
        {"<bsdf type='twosided' id='a'><ref id='a'/></bsdf>",
         "2:1: error: reference cycle (bsdf 'a' contains itself)"},
        {"<bsdf type='twosided' id='a'><ref id='b'/></bsdf>\n"
         "<bsdf type='twosided' id='b'><ref id='a'/></bsdf>",
         "2:1: error: reference cycle (bsdf 'a' contains itself)"},
        {"<shape type='cube' id='a'/><shape type='cube'><ref id='a'/></shape>",
         "2:47: error: <shape> by <ref> in shape 'cube' is not supported"},
        {"<integrator type='moment' id='a'><ref id='a'/></integrator>",
         "2:1: error: integrator 'moment' with 1 nested integrators"},
        {"<bsdf type='twosided'/>", "2:1: error: bsdf 'twosided' with 0 nested bsdfs"},
        {"<alias id='a' as='b'/>", "2:12: error: reference to nothing (got 'a'"},
    });
}

TEST_F(BadXml, BadParametersAreRefused) {
    expect_refused_in_scene({
        {"<default name='spp' value='4'/>\n<integrator type='$ssp'/>",
         "3:19: error: undefined parameter '$ssp' (did you mean 'spp'?) (give it a <default> or "
         "-D ssp=...)"},
        {"<integrator type='$'/>", "2:19: error: undefined parameter '$'"},
        {"<default name='a b' value='4'/>", "2:16: error: bad parameter name (got 'a b'"},
        {"<default name='' value='4'/>", "2:10: error: bad parameter name (got ''"},
        {"<default name='a'/>", "2:1: error: missing attribute 'value' of <default>"},
        {"<integrator type='path'><integer name='max_depth' value='$n'/></integrator>"
         "<default name='n' value='4'/>",
         "2:58: error: undefined parameter '$n'"},
    });
}

TEST_F(BadXml, BadIncludesAreRefusedWithTheChain) {
    write("a.xml", "<scene version='3.0.0'>\n <include filename='b.xml'/></scene>");
    write("b.xml", "<scene version='3.0.0'>\n\n<include filename='a.xml'/></scene>");
    EXPECT_EQ(error(in_scene("<include filename='a.xml'/>")),
              "b.xml:3:20: error: 'a.xml' includes itself\n"
              "  included from a.xml:2:2\n"
              "  included from scene.xml:2:1");
    EXPECT_EQ(error(in_scene("<include filename='scene.xml'/>")),
              "scene.xml:2:20: error: 'scene.xml' includes itself");
    EXPECT_EQ(error(in_scene("<include filename='none.xml'/>")),
              "scene.xml:2:20: error: included file 'none.xml' not found");
    EXPECT_EQ(error(in_scene("<include/>")),
              "scene.xml:2:1: error: missing attribute 'filename' of <include>");
    write("bad.xml", "<scene version='3.0.0'>\n<shape type='cube'></scene>");
    EXPECT_EQ(error(in_scene("<include filename='bad.xml'/>")),
              "bad.xml:2:20: error: mismatched tags (got </scene>, expected </shape> for line "
              "2:1)\n  included from scene.xml:2:1");
    write("wrong.xml", "<shape type='sphere'><float name='radius' value='-1'/></shape>");
    EXPECT_EQ(error(in_scene("<include filename='wrong.xml'/>")),
              "wrong.xml:1:50: error: bad value of 'radius' (got '-1', expected a number above 0)\n"
              "  included from scene.xml:2:1");
    std::filesystem::create_directory(folder() / "folder");
    EXPECT_EQ(error(in_scene("<include filename='folder'/>")),
              "folder: error: is a directory (expected a file)\n  included from scene.xml:2:1");
}

TEST_F(BadXml, IncludesAreLimitedInDepthAndNumber) {
    for (int i = 0; i < 20; ++i)
        write("deep" + std::to_string(i) + ".xml",
              "<scene version='3.0.0'><include filename='deep" + std::to_string(i + 1) +
                  ".xml'/></scene>");
    const std::string deep = error(in_scene("<include filename='deep0.xml'/>"));
    EXPECT_EQ(deep.find("deep14.xml:1:43: error: includes nested too deeply (expected at most 15)"),
              0u)
        << deep;

    // Ten includes at each of ten levels would be 10^10 files.
    for (int i = 0; i < 10; ++i) {
        std::string ten;
        for (int k = 0; k < 10; ++k)
            ten += "<include filename='wide" + std::to_string(i + 1) + ".xml'/>";
        write("wide" + std::to_string(i) + ".xml", "<scene version='3.0.0'>" + ten + "</scene>");
    }
    write("wide10.xml", "<scene version='3.0.0'/>");
    EXPECT_NE(error(in_scene("<include filename='wide0.xml'/>"))
                  .find("error: too many includes (expected at most 1000)"),
              std::string::npos);
}

TEST_F(BadXml, MissingMeshFilesAreMeshErrorsAtTheFileName) {
    EXPECT_EQ(error(in_scene("<shape type='obj'><string name='filename' value='a.obj'/></shape>"),
                    ErrorKind::mesh),
              "scene.xml:2:50: error: file 'a.obj' not found");
    EXPECT_EQ(error(in_scene("<shape type='obj'><string name='filename' value=''/></shape>"),
                    ErrorKind::mesh),
              "scene.xml:2:43: error: file '' not found");
}

TEST_F(BadXml, MessagesCarryNoControlCharacters) {
    EXPECT_EQ(error(in_scene("<shape type='a&#10;b&#x7f;'/>")).substr(0, 43),
              "scene.xml:2:14: error: unknown plugin 'a?b?");
}

} // namespace
} // namespace plumb::test
