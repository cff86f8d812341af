/// \file  Values that scene files must not have: numbers, cameras, transforms, shapes, materials.

#include "tests/renderer/io/bad_xml.h"

namespace plumb::test {
namespace {

TEST_F(BadXml, NumbersMustBeWholeAndFinite) {
    const auto radius = [](const std::string& value) {
        return "<shape type='sphere'><float name='radius' value='" + value + "'/></shape>";
    };
    const auto depth = [](const std::string& value) {
        return "<integrator type='path'><integer name='max_depth' value='" + value +
               "'/></integrator>";
    };
    for (const char* bad : {"1,5", "12abc", " ", "nan", "inf", "1e999", "1e39", "0x10", "1 2", "-"})
        EXPECT_EQ(error(in_scene(radius(bad))),
                  "scene.xml:2:50: error: bad value of 'radius' (got '" + std::string(bad) +
                      "', expected a finite decimal number)");
    EXPECT_EQ(error(in_scene(radius(""))),
              "scene.xml:2:43: error: bad value of 'radius' (got '', expected a finite decimal "
              "number)");
    for (const char* bad : {"99999999999", "-2", "1.5", "", "1e3", "four", "0x10"})
        EXPECT_NE(error(in_scene(depth(bad)))
                      .find("error: bad value of 'max_depth' (got '" + std::string(bad) +
                            "', expected an integer"),
                  std::string::npos);
    expect_refused_in_scene({
        {depth("0"), "2:58: error: bad value of 'max_depth' (got '0', expected -1 (no limit)"},
        {"<integrator type='path'><boolean name='hide_emitters' value='1'/></integrator>",
         "2:62: error: bad value of 'hide_emitters' (got '1', expected true or false)"},
        {"<integrator type='path'><float name='max_depth' value='1'/></integrator>",
         "2:25: error: property 'max_depth' of integrator 'path' has the wrong type (got <float>, "
         "expected <integer>)"},
        {"<shape type='sphere'><point name='center' value='1 2'/></shape>",
         "2:50: error: bad value of <point> (got 2 numbers, expected 3 or 1)"},
        {"<shape type='sphere'><point name='center' value='1 2 x'/></shape>",
         "2:50: error: bad number in 'value' of <point> (got 'x', expected a finite"},
        {"<shape type='sphere'><point name='center' x='1' value='1 2 3'/></shape>",
         "2:46: error: <point> with both 'value' and 'x'"},
        {"<shape type='sphere'><point name='center' x='1e39'/></shape>",
         "2:22: error: bad value of 'center' (expected coordinates within the range of float)"},
        {"<shape type='sphere'><point name='center'/></shape>",
         "2:22: error: missing attribute 'value' (or x, y, z) of <point>"},
    });
}

TEST_F(BadXml, SensorsOutOfRangeAreRefused) {
    const auto sensor = [](const std::string& body) {
        return "<sensor type='perspective'>" + body + "</sensor>";
    };
    const auto film = [&](const std::string& body) {
        return sensor("\n<film type='hdrfilm'>" + body + "</film>");
    };
    std::vector<BadCase> cases;
    for (const char* size : {"0", "-1", "1000000000", "99999999999"})
        for (const char* side : {"width", "height"})
            cases.push_back(
                {film("<integer name='" + std::string(side) + "'\nvalue='" + size + "'/>"),
                 "4:8: error: bad value of '"});
    expect_refused_in_scene(cases);
    expect_refused_in_scene({
        {film("<integer name='width' value='0'/>"),
         "3:51: error: bad value of 'width' (got '0', expected an integer from 1 to 65536)"},
        {film("<integer name='crop_width' value='769'/>"),
         "3:56: error: bad value of 'crop_width' (got '769', expected an integer from 1 to 768)"},
        {film("<integer name='crop_offset_y' value='576'/>"),
         "3:59: error: bad value of 'crop_offset_y' (got '576', expected an integer from 0 to"},
        {film("<rfilter type='tent'><float name='radius' value='0'/></rfilter>"),
         "3:71: error: bad value of 'radius' (got '0', expected a number above 0)"},
        {film("<rfilter type='lanczos'/>"),
         "3:37: error: plugin 'lanczos' (rfilter) is not supported yet (supported: box, tent"},
        {sensor("<sampler type='sobol'><integer name='sample_count' value='0'/></sampler>"),
         "2:86: error: bad value of 'sample_count' (got '0', expected an integer from 1"},
        {sensor("<sampler type='sobol'><integer name='sample_count' value='-1'/></sampler>"),
         "2:86: error: bad value of 'sample_count' (got '-1', expected an integer from 1"},
        {sensor("<float name='fov' value='0'/>"),
         "2:53: error: bad value of 'fov' (got '0', expected degrees above 0 and below 180)"},
        {sensor("<float name='fov' value='180'/>"), "2:53: error: bad value of 'fov' (got '180'"},
        {sensor("<float name='near_clip' value='0'/>"), "2:59: error: bad value of 'near_clip'"},
        {sensor("<float name='near_clip' value='9'/><float name='far_clip' value='8'/>"),
         "2:93: error: bad value of 'far_clip' (got '8', expected near_clip (9) below far_clip"},
        {sensor("<string name='fov_axis' value='z'/>"),
         "2:59: error: bad value of 'fov_axis' (got 'z', expected one of x, y, diagonal, smaller"},
        {sensor("<string name='focal_length' value='50cm'/>"),
         "2:63: error: bad value of 'focal_length' (got '50cm', expected millimetres such as"},
        {"<sensor type='thinlens'/>", "2:15: error: plugin 'thinlens' (sensor) is not supported"},
    });
}

TEST_F(BadXml, BadTransformsAreRefused) {
    const auto cube = [](const std::string& operations) {
        return "<shape type='cube'>\n<transform name='to_world'>\n" + operations +
               "\n</transform></shape>";
    };
    expect_refused_in_scene({
        {cube("<lookat origin='1 2 3' target='1 2 3' up='0 1 0'/>"),
         "4:1: error: lookat with origin = target"},
        {cube("<lookat origin='0 0 0' target='0 5 0' up='0 1 0'/>"),
         "4:1: error: lookat with 'up' parallel to the view"},
        {cube("<lookat origin='0 0 0' target='0 5 0' up='0 0 0'/>"),
         "4:1: error: lookat with 'up' parallel to the view, or zero"},
        {cube("<lookat origin='0 0 0' target='0 5 0'/>"),
         "4:1: error: missing attribute 'up' of <lookat>"},
        {cube("<lookAt origin='0 0' target='0 5 0' up='1 0 0'/>"),
         "4:17: error: bad 'origin' of <lookAt> (got 2 numbers, expected 3)"},
        {cube("<matrix value='1 0 0 0 0 1 0 0 0 0 1 0 0 0 0'/>"),
         "4:16: error: bad matrix (got 15 numbers, expected 16 or 9)"},
        {cube("<matrix value='1 0 0 0 0 1 0 0 1 1 0 0 0 0 0 1'/>"),
         "4:16: error: matrix is singular"},
        {cube("<matrix value='1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1'/>"),
         "4:16: error: matrix is not affine (got last row '0 0 1 1', expected '0 0 0 1')"},
        {cube("<matrix value='1 0 0 0 nan 1 0 0 0'/>"), "4:16: error: bad number in 'value'"},
        {cube("<scale value='0'/>"), "4:1: error: scale without an inverse (got '0 0 0'"},
        {cube("<scale x='1' y='0' z='1'/>"), "4:1: error: scale without an inverse (got '1 0 1'"},
        {cube("<rotate angle='90'/>"), "4:1: error: missing attribute 'value' (or x, y, z)"},
        {cube("<rotate x='0' angle='90'/>"), "4:1: error: rotate without an axis"},
        {cube("<rotate x='1'/>"), "4:1: error: missing attribute 'angle' of <rotate>"},
        {cube("<rotate x='1' angle='9o'/>"), "4:22: error: bad number in 'angle' of <rotate>"},
        {cube("<scale value='1e100'/>\n<scale value='1e100'/>"),
         "5:1: error: transform is singular or overflows"},
        {cube("<translate x='1e30'/>"), "2:1: error: vertices of 'cube' too far away"},
    });
}

TEST_F(BadXml, BadShapesMaterialsAndLightsAreRefused) {
    expect_refused_in_scene({
        {"<shape type='sphere'><float name='radius' value='0'/></shape>",
         "2:50: error: bad value of 'radius' (got '0', expected a number above 0)"},
        {"<shape type='sphere'><float name='radius' value='-1'/></shape>",
         "2:50: error: bad value of 'radius' (got '-1', expected a number above 0)"},
        {"<shape type='cylinder'><float name='radius' value='0'/></shape>",
         "2:52: error: bad value of 'radius'"},
        {"<shape type='cylinder'><point name='p0' value='0 0 1'/></shape>",
         "2:1: error: cylinder with p0 = p1"},
        {"<shape type='sphere'><transform name='to_world'><scale x='2'/></transform></shape>",
         "2:1: error: sphere with a non-uniform scale"},
        {"<shape type='sphere'><float name='radius' value='1e30'/></shape>",
         "2:1: error: sphere out of range"},
        {"<bsdf type='diffuse'><rgb name='reflectance' value='0.5 1.1 0.5'/></bsdf>",
         "2:53: error: bad value of 'reflectance' (got '0.5 1.1 0.5', expected values from 0 to 1"},
        {"<bsdf type='diffuse'><rgb name='reflectance' value='-0.1'/></bsdf>",
         "2:53: error: bad value of 'reflectance' (got '-0.1', expected values from 0 to 1)"},
        {"<bsdf type='diffuse'><rgb name='reflectance' value='1 2'/></bsdf>",
         "2:53: error: bad colour (got 2 numbers, expected 3, 1 or #rrggbb)"},
        {"<bsdf type='diffuse'><rgb name='reflectance' value='#12345g'/></bsdf>",
         "2:53: error: bad colour (got '#12345g', expected #rrggbb)"},
        {"<bsdf type='diffuse'><rgb name='reflectance' value=''/></bsdf>",
         "2:46: error: bad colour (got 0 numbers"},
        {"<bsdf type='diffuse'><spectrum name='reflectance' value='0.1 0.2 0.3'/></bsdf>",
         "2:58: error: bad value of <spectrum> (got 3 numbers, expected one)"},
        {"<bsdf type='diffuse'><spectrum name='reflectance' value='400:0.1, 700:0.2'/></bsdf>",
         "2:22: error: a spectrum of wavelengths as 'reflectance' of bsdf 'diffuse' is not "
         "supported yet"},
        {"<bsdf type='diffuse'><texture name='reflectance' type='bitmap'/></bsdf>",
         "2:22: error: texture 'bitmap' as 'reflectance' of bsdf 'diffuse' is not supported yet"},
        {"<texture type='bitmap' id='t'/>", "2:1: error: plugin 'bitmap' (texture) is not"},
        {"<bsdf type='roughconductor'/>",
         "2:13: error: plugin 'roughconductor' (bsdf) is not supported yet (supported: diffuse, "
         "twosided)"},
        {"<shape type='serialized'/>", "2:14: error: plugin 'serialized' (shape) is not supported"},
        {"<integrator type='volpath'/>", "2:19: error: plugin 'volpath' (integrator) is not"},
        {"<integrator type='aov'/>", "2:19: error: plugin 'aov' (integrator) is not supported"},
        {"<medium type='homogeneous'/>", "2:1: error: plugin 'homogeneous' (medium) is not"},
        {"<shape type='cube'><medium name='interior' type='homogeneous'/></shape>",
         "2:20: error: <medium> in shape 'cube' is not supported yet"},
        {"<shape type='cube'><emitter type='area'><rgb name='radiance' value='1 -1 1'/>"
         "</emitter></shape>",
         "2:69: error: bad value of 'radiance' (got '1 -1 1', expected values not below 0)"},
        {"<emitter type='point'><rgb name='intensity' value='-1'/></emitter>",
         "2:52: error: bad value of 'intensity' (got '-1'"},
        {"<emitter type='constant'><rgb name='radiance' value='-1'/></emitter>",
         "2:54: error: bad value of 'radiance' (got '-1'"},
        {"<emitter type='envmap'/>", "2:16: error: plugin 'envmap' (emitter) is not supported"},
        {"<emitter type='area'/>", "2:1: error: emitter 'area' outside a shape"},
        {"<emitter type='point'><point name='position' value='1'/><transform name='to_world'/>"
         "</emitter>",
         "2:1: error: emitter 'point' with both 'position' and 'to_world'"},
    });
}

} // namespace
} // namespace plumb::test
