/// \file  What good scene files become: all plugins, both spellings, includes, parameters.

#include "tests/renderer/io/load_scene_files.h"

#include <algorithm>
#include <cmath>

namespace plumb::test {
namespace {

class LoadScene : public SceneFiles {
  protected:
    [[nodiscard]] Scene body(const std::string& text, bool lenient = false) const {
        return load(in_scene(text), {}, lenient);
    }
};

using Lines = std::vector<std::string>;

bool any_contains(const Lines& lines, std::string_view text) {
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string& l) { return l.find(text) != std::string::npos; });
}

void expect_same(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.meshes.size(), b.meshes.size());
    for (std::size_t i = 0; i < a.meshes.size(); ++i) {
        EXPECT_EQ(a.meshes[i].name, b.meshes[i].name);
        EXPECT_EQ(a.meshes[i].is_rectangle, b.meshes[i].is_rectangle);
        EXPECT_TRUE(a.meshes[i].positions == b.meshes[i].positions) << i;
        EXPECT_TRUE(a.meshes[i].normals == b.meshes[i].normals) << i;
        ASSERT_EQ(a.meshes[i].triangles.size(), b.meshes[i].triangles.size());
    }
    ASSERT_EQ(a.spheres.size(), b.spheres.size());
    for (std::size_t i = 0; i < a.spheres.size(); ++i) {
        EXPECT_TRUE(a.spheres[i].center == b.spheres[i].center);
        EXPECT_EQ(a.spheres[i].radius, b.spheres[i].radius);
    }
    ASSERT_EQ(a.surfaces.size(), b.surfaces.size());
    for (std::size_t i = 0; i < a.surfaces.size(); ++i) {
        EXPECT_EQ(a.surfaces[i].front, b.surfaces[i].front);
        EXPECT_EQ(a.surfaces[i].back, b.surfaces[i].back);
        EXPECT_EQ(a.surfaces[i].emission, b.surfaces[i].emission);
        EXPECT_EQ(a.surfaces[i].flip_normal, b.surfaces[i].flip_normal);
    }
    ASSERT_EQ(a.materials.size(), b.materials.size());
    for (std::size_t i = 0; i < a.materials.size(); ++i)
        EXPECT_EQ(a.materials[i].reflectance, b.materials[i].reflectance);
    EXPECT_EQ(a.environment, b.environment);
    EXPECT_EQ(a.camera.fov_deg, b.camera.fov_deg);
    EXPECT_EQ(a.camera.fov_axis, b.camera.fov_axis);
    EXPECT_EQ(a.camera.near_clip, b.camera.near_clip);
    EXPECT_EQ(a.camera.far_clip, b.camera.far_clip);
    EXPECT_EQ(a.camera.principal_x, b.camera.principal_x);
    EXPECT_EQ(a.camera.principal_y, b.camera.principal_y);
    EXPECT_EQ(a.camera.to_world.m, b.camera.to_world.m);
    EXPECT_EQ(a.film.width, b.film.width);
    EXPECT_EQ(a.film.crop.x, b.film.crop.x);
    EXPECT_EQ(a.film.crop.width, b.film.crop.width);
    EXPECT_EQ(a.film.filter.kind, b.film.filter.kind);
    EXPECT_EQ(a.film.filter.stddev, b.film.filter.stddev);
    EXPECT_EQ(a.sampler.kind, b.sampler.kind);
    EXPECT_EQ(a.sampler.spp, b.sampler.spp);
    EXPECT_EQ(a.path.max_depth, b.path.max_depth);
    EXPECT_EQ(a.path.rr_depth, b.path.rr_depth);
    EXPECT_EQ(a.path.hide_emitters, b.path.hide_emitters);
}

TEST_F(LoadScene, OldAndNewDialectsGiveTheSameScene) {
    const Scene old_scene = load(R"(<?xml version="1.0" encoding="utf-8"?>
<scene version="0.4.0">
  <integrator type="path"><integer name="maxDepth" value="7"/><integer name="rrDepth" value="3"/>
    <boolean name="hideEmitters" value="true"/><boolean name="strictNormals" value="TRUE"/>
  </integrator>
  <sensor type="perspective">
    <float name="fov" value="35"/><string name="fovAxis" value="smaller"/>
    <float name="nearClip" value="10"/><float name="farClip" value="2800"/>
    <float name="principalPointOffsetX" value="0.1"/><float name="focusDistance" value="3"/>
    <transform name="toWorld"><lookAt origin="1, 2, 3" target="4, 5, 7" up="0, 1, 0"/></transform>
    <sampler type="sobol"><integer name="sampleCount" value="8"/></sampler>
    <film type="ldrfilm"><integer name="width" value="64"/><integer name="height" value="32"/>
      <integer name="cropOffsetX" value="4"/><integer name="cropWidth" value="10"/>
      <string name="fileFormat" value="png"/><float name="gamma" value="2.2"/>
      <boolean name="banner" value="false"/>
      <rfilter type="gaussian"><float name="stddev" value="0.4"/></rfilter></film>
  </sensor>
  <bsdf type="twosided" id="m"><bsdf type="diffuse"><rgb name="diffuseReflectance"
    value="0.1, 0.2, 0.3"/></bsdf></bsdf>
  <shape type="rectangle" id="r"><transform name="toWorld"><scale x="2" y="3"/>
    <rotate z="1" angle="30"/><translate x="1" y="2" z="3"/></transform><ref id="m"/>
    <boolean name="flipNormals" value="true"/></shape>
  <shape type="sphere"><float name="radius" value="2"/><emitter type="area">
    <spectrum name="radiance" value="3"/></emitter></shape>
  <emitter type="constant"><rgb name="radiance" value="0.25"/></emitter>
</scene>)");
    const Scene new_scene = load(R"(<scene version="3.5.0">
  <integrator type="path"><integer name="max_depth" value="7"/><integer name="rr_depth" value="3"/>
    <boolean name="hide_emitters" value="true"/><boolean name="strict_normals" value="true"/>
  </integrator>
  <sensor type="perspective">
    <float name="fov" value="35"/><string name="fov_axis" value="smaller"/>
    <float name="near_clip" value="10"/><float name="far_clip" value="2800"/>
    <float name="principal_point_offset_x" value="0.1"/>
    <transform name="to_world"><lookat origin="1 2 3" target="4 5 7" up="0 1 0"/></transform>
    <sampler type="sobol"><integer name="sample_count" value="8"/></sampler>
    <film type="hdrfilm"><integer name="width" value="64"/><integer name="height" value="32"/>
      <integer name="crop_offset_x" value="4"/><integer name="crop_width" value="10"/>
      <string name="pixel_format" value="rgb"/>
      <rfilter type="gaussian"><float name="stddev" value="0.4"/></rfilter></film>
  </sensor>
  <emitter type="constant"><float name="radiance" value="0.25"/></emitter>
  <shape type="rectangle" id="r"><boolean name="flip_normals" value="true"/>
    <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.1 0.2 0.3"/></bsdf>
    </bsdf><transform name="to_world"><scale value="2 3 1"/><rotate value="0 0 1" angle="30"/>
    <translate value="1, 2, 3"/></transform></shape>
  <shape type="sphere"><float name="radius" value="2"/><emitter type="area">
    <rgb name="radiance" value="3"/></emitter></shape>
</scene>)");
    expect_same(old_scene, new_scene);

    // And both are what they say.
    EXPECT_TRUE(old_scene.warnings.empty());
    EXPECT_EQ(old_scene.path.max_depth, 7);
    EXPECT_EQ(old_scene.path.rr_depth, 3);
    EXPECT_TRUE(old_scene.path.hide_emitters);
    EXPECT_EQ(old_scene.camera.fov_deg, 35);
    EXPECT_EQ(old_scene.camera.fov_axis, FovAxis::smaller);
    EXPECT_EQ(old_scene.camera.near_clip, 10);
    EXPECT_EQ(old_scene.camera.far_clip, 2800);
    EXPECT_EQ(old_scene.camera.principal_x, 0.1);
    EXPECT_EQ(old_scene.camera.to_world.m[0][3], 1);
    EXPECT_EQ(old_scene.camera.to_world.m[2][3], 3);
    EXPECT_EQ(old_scene.sampler.spp, 8u);
    EXPECT_EQ(old_scene.film.height, 32);
    EXPECT_EQ(old_scene.film.crop.x, 4);
    EXPECT_EQ(old_scene.film.crop.y, 0);
    EXPECT_EQ(old_scene.film.crop.width, 10);
    EXPECT_EQ(old_scene.film.crop.height, 32);
    EXPECT_EQ(old_scene.film.filter.stddev, 0.4f);
    EXPECT_EQ(old_scene.environment, (Rgb{0.25f, 0.25f, 0.25f}));
    EXPECT_EQ(old_scene.surfaces[1].emission, (Rgb{3, 3, 3}));
    EXPECT_EQ(old_scene.materials[0].reflectance, (Rgb{0.1f, 0.2f, 0.3f}));
    EXPECT_TRUE(any_contains(old_scene.ignored, "scene.xml:14:7: 'file_format' of film 'ldrfilm'"));
    EXPECT_EQ(old_scene.ignored.size(), 4u); // focus distance, format, gamma, banner
}

TEST_F(LoadScene, AnEmptySceneHasDefaultsAndWarnings) {
    const Scene scene = body("");
    EXPECT_TRUE(any_contains(scene.warnings, "no sensor"));
    EXPECT_TRUE(any_contains(scene.warnings, "no emitter"));
    EXPECT_TRUE(any_contains(scene.warnings, "no shape"));
    EXPECT_EQ(scene.film.width, 768);
    EXPECT_EQ(scene.film.height, 576);
    EXPECT_EQ(scene.sampler.kind, SamplerKind::sobol);
    EXPECT_EQ(scene.path.max_depth, -1);
    EXPECT_EQ(scene.path.rr_depth, 5);
    EXPECT_TRUE(any_contains(load("<scene/>").warnings, "<scene> without a version"));
}

TEST_F(LoadScene, SensorDefaultsAreMitsubas) {
    const Scene scene = body("<sensor type='perspective'><film type='hdrfilm'/>"
                             "<sampler type='independent'/></sensor>");
    // A 50 mm lens before a 36 x 24 mm frame.
    EXPECT_NEAR(scene.camera.fov_deg, 46.7930, 1e-4);
    EXPECT_EQ(scene.camera.fov_axis, FovAxis::diagonal);
    EXPECT_EQ(scene.camera.near_clip, 1e-2);
    EXPECT_EQ(scene.camera.far_clip, 1e4);
    EXPECT_EQ(scene.film.filter.kind, FilterKind::gaussian);
    EXPECT_EQ(scene.film.filter.stddev, 0.5f);
    EXPECT_EQ(scene.sampler.kind, SamplerKind::independent);
    EXPECT_EQ(scene.sampler.spp, 4u);
    EXPECT_FALSE(any_contains(scene.warnings, "no sensor"));
    const Scene tele = body("<sensor type='perspective'><string name='focal_length' "
                            "value='100mm'/></sensor>");
    EXPECT_NEAR(tele.camera.fov_deg,
                2 * std::atan(std::hypot(36, 24) / 200) * 180 / 3.14159265358979, 1e-9);
}

TEST_F(LoadScene, FiltersAndSamplersAreReadByName) {
    const auto filter = [&](const std::string& text) {
        return body("<sensor type='perspective'><film type='hdrfilm'><rfilter " + text +
                    "</rfilter></film></sensor>")
            .film.filter;
    };
    EXPECT_EQ(filter("type='box'>").kind, FilterKind::box);
    EXPECT_EQ(filter("type='tent'>").radius, 1);
    const Filter tent = filter("type='tent'><float name='radius' value='1.5'/>");
    EXPECT_EQ(tent.kind, FilterKind::tent);
    EXPECT_EQ(tent.radius, 1.5f);
    const Filter mitchell =
        filter("type='mitchell'><float name='B' value='0.25'/><float name='C' value='0.5'/>");
    EXPECT_EQ(mitchell.kind, FilterKind::mitchell);
    EXPECT_EQ(mitchell.b, 0.25f);
    EXPECT_EQ(mitchell.c, 0.5f);

    for (const char* name :
         {"ldsampler", "halton", "hammersley", "stratified", "multijitter", "orthogonal"}) {
        const Scene scene = body("<sensor type='perspective'><sampler type='" + std::string(name) +
                                 "'><integer name='seed' value='9'/></sampler></sensor>");
        EXPECT_EQ(scene.sampler.kind, SamplerKind::sobol);
        EXPECT_EQ(scene.sampler.seed, 9u);
        EXPECT_TRUE(
            any_contains(scene.ignored, "sampler '" + std::string(name) + "' is taken as sobol"));
    }
}

TEST_F(LoadScene, IntegratorsThatPathCoversAreTaken) {
    const Scene direct = body("<integrator type='direct'><integer name='emitterSamples' "
                              "value='4'/></integrator>");
    EXPECT_EQ(direct.path.max_depth, 2);
    EXPECT_TRUE(any_contains(direct.ignored, "'direct' is taken as path with max_depth 2"));
    const Scene moment = body("<integrator type='moment'><integrator type='path'>"
                              "<integer name='max_depth' value='3'/></integrator></integrator>");
    EXPECT_EQ(moment.path.max_depth, 3);
    EXPECT_TRUE(any_contains(moment.ignored, "'moment'"));
}

TEST_F(LoadScene, SecondSensorIsAWarning) {
    const Scene scene = body("<sensor type='perspective'><float name='fov' value='10'/></sensor>\n"
                             "<sensor type='perspective'><float name='fov' value='20'/></sensor>");
    EXPECT_EQ(scene.camera.fov_deg, 10);
    EXPECT_TRUE(any_contains(scene.warnings, "scene.xml:3:1: warning: second sensor"));
}

TEST_F(LoadScene, ShapesWithoutBsdfAreGreyInFrontAndEmittersBlack) {
    const Scene scene =
        body("<shape type='cube'/><shape type='disk'><emitter type='area'/></shape>");
    ASSERT_EQ(scene.surfaces.size(), 2u);
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials[0].reflectance, (Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(scene.surfaces[0].front, 0u);
    EXPECT_EQ(scene.surfaces[0].back, invalid_id);
    EXPECT_EQ(scene.surfaces[1].front, invalid_id);
    EXPECT_EQ(scene.surfaces[1].back, invalid_id);
    EXPECT_EQ(scene.surfaces[1].emission, (Rgb{1, 1, 1}));
}

TEST_F(LoadScene, MaterialsAreSharedByReferenceAndByValue) {
    const Scene scene = body(R"(
<shape type="cube"><ref name="bsdf" id="later"/></shape>
<bsdf type="diffuse" id="later"><rgb name="reflectance" value="0.2"/></bsdf>
<alias id="later" as="other"/>
<shape type="cube"><ref id="other"/></shape>
<shape type="cube"><bsdf type="diffuse"><rgb name="reflectance" value="0.2"/></bsdf></shape>
<bsdf type="diffuse" id="red"><rgb name="reflectance" value="1 0 0"/></bsdf>
<shape type="cube"><bsdf type="twosided"><ref id="later"/><ref id="red"/></bsdf></shape>
<shape type="cube"><bsdf type="twosided"><ref id="red"/></bsdf></shape>)");
    ASSERT_EQ(scene.materials.size(), 2u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(scene.surfaces[i].front, 0u);
        EXPECT_EQ(scene.surfaces[i].back, invalid_id);
    }
    EXPECT_EQ(scene.surfaces[3].front, 0u);
    EXPECT_EQ(scene.surfaces[3].back, 1u);
    EXPECT_EQ(scene.surfaces[4].front, 1u);
    EXPECT_EQ(scene.surfaces[4].back, 1u);
}

TEST_F(LoadScene, SurfacesComeMeshesFirstInTheOrderOfTheFile) {
    const auto light = [](const char* shape, const char* radiance) {
        return "<shape type='" + std::string(shape) +
               "'><emitter type='area'><float "
               "name='radiance' value='" +
               radiance + "'/></emitter></shape>";
    };
    const Scene scene = body(light("sphere", "1") + light("cube", "2") + light("sphere", "3") +
                             light("disk", "4") + light("cylinder", "5"));
    ASSERT_EQ(scene.meshes.size(), 3u);
    ASSERT_EQ(scene.surfaces.size(), 5u);
    const std::array expected{2.0f, 4.0f, 5.0f, 1.0f, 3.0f};
    for (std::size_t i = 0; i < 5; ++i)
        EXPECT_EQ(scene.surfaces[i].emission.r, expected[i]);
    EXPECT_EQ(scene.meshes[1].name, "disk");
}

TEST_F(LoadScene, SpheresTakeRigidTransformsAndUniformScale) {
    const Scene scene = body(R"(<shape type="sphere"><point name="center" x="1" y="0" z="0"/>
<float name="radius" value="0.5"/><boolean name="flip_normals" value="true"/>
<transform name="to_world"><scale x="-3" y="3" z="3"/><rotate z="1" angle="90"/>
<translate y="1"/></transform></shape>)");
    ASSERT_EQ(scene.spheres.size(), 1u);
    // (1,0,0) -> (-3,0,0) -> (0,-3,0) -> (0,-2,0)
    EXPECT_NEAR(scene.spheres[0].center.x, 0, 1e-6);
    EXPECT_NEAR(scene.spheres[0].center.y, -2, 1e-6);
    EXPECT_NEAR(scene.spheres[0].radius, 1.5, 1e-6);
    EXPECT_TRUE(scene.surfaces[0].flip_normal);
}

TEST_F(LoadScene, TransformsActInTheOrderOfTheFile) {
    // Scale first, then translate: (1,1,0) -> (2,2,0) -> (12,2,0). The rectangle's corner (1,1).
    const Scene scene = body("<shape type='rectangle'><transform name='to_world'><scale value='2'/>"
                             "<translate x='10'/></transform></shape>");
    const auto& p = scene.meshes[0].positions;
    EXPECT_NE(std::find(p.begin(), p.end(), Vec3{12, 2, 0}), p.end());
    EXPECT_NE(std::find(p.begin(), p.end(), Vec3{8, -2, 0}), p.end());
    // A 3x3 matrix and the same as 4x4.
    const Scene nine = body("<shape type='rectangle'><transform name='to_world'>"
                            "<matrix value='0 -1 0 1 0 0 0 0 1'/></transform></shape>");
    const Scene sixteen = body("<shape type='rectangle'><transform name='to_world'><matrix "
                               "value='0,-1,0,0, 1,0,0,0, 0,0,1,0, 0,0,0,1'/></transform></shape>");
    EXPECT_TRUE(nine.meshes[0].positions == sixteen.meshes[0].positions);
    EXPECT_FALSE(nine.meshes[0].positions == p);
}

TEST_F(LoadScene, PointLightsHaveAPositionOrATransform) {
    const Scene scene = body(R"(
<emitter type="point"><point name="position" x="1" z="3"/><rgb name="intensity" value="1 2 3"/>
  <float name="sampling_weight" value="2"/></emitter>
<emitter type="point"><transform name="toWorld"><translate x="4" y="5" z="6"/></transform></emitter>
)");
    ASSERT_EQ(scene.point_lights.size(), 2u);
    EXPECT_EQ(scene.point_lights[0].position, (Vec3{1, 0, 3}));
    EXPECT_EQ(scene.point_lights[0].intensity, (Rgb{1, 2, 3}));
    EXPECT_EQ(scene.point_lights[1].position, (Vec3{4, 5, 6}));
    EXPECT_EQ(scene.point_lights[1].intensity, (Rgb{1, 1, 1}));
    EXPECT_FALSE(any_contains(scene.warnings, "no emitter"));
}

TEST_F(LoadScene, LenientReplacesByNameAndReports) {
    const Scene scene = body(R"(
<integrator type="volpath"><integer name="maxDepth" value="5"/><float name="other" value="1"/>
</integrator>
<sensor type="thinlens"><float name="fov" value="20"/><float name="apertureRadius" value="1"/>
  <film type="hdrfilm"><rfilter type="lanczos"><integer name="lobes" value="3"/></rfilter></film>
</sensor>
<bsdf type="roughconductor" id="m"><float name="alpha" value="0.1"/></bsdf>
<shape type="cube"><ref id="m"/><medium type="homogeneous" name="interior"/></shape>
<shape type="serialized"/>
<shape type="cube"><bsdf type="diffuse"><rgb name="reflectance" value="1.5 0.5 0.25"/></bsdf></shape>
<shape type="cube"><bsdf type="diffuse"><spectrum name="reflectance" value="400:0.1, 700:0.3"/>
</bsdf></shape>
<emitter type="envmap"/>)",
                             true);
    EXPECT_EQ(scene.path.max_depth, 5);
    EXPECT_EQ(scene.camera.fov_deg, 20);
    EXPECT_EQ(scene.film.filter.kind, FilterKind::gaussian);
    ASSERT_EQ(scene.meshes.size(), 3u);
    EXPECT_EQ(scene.materials[scene.surfaces[0].front].reflectance, (Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(scene.surfaces[0].back, scene.surfaces[0].front);
    EXPECT_EQ(scene.materials[scene.surfaces[1].front].reflectance, (Rgb{1, 0.5f, 0.25f}));
    EXPECT_NEAR(scene.materials[scene.surfaces[2].front].reflectance.g, 0.2, 1e-6);
    for (const char* text :
         {"'other' of integrator 'volpath' left out", "plugin 'thinlens'",
          "'aperture_radius' of sensor 'thinlens' left out", "plugin 'lanczos'",
          "plugin 'roughconductor' (bsdf) is not supported yet (supported: diffuse, twosided); "
          "taken as diffuse 0.5 on both sides",
          "<medium> in shape 'cube' is not supported yet; left out", "plugin 'serialized'",
          "clamped to 1 0.5 0.25", "a spectrum of wavelengths as 'reflectance'", "plugin 'envmap'"})
        EXPECT_TRUE(any_contains(scene.ignored, text)) << text;
    EXPECT_TRUE(any_contains(scene.ignored, "scene.xml:3:1: plugin 'volpath'"));
    // A wrong name stays an error.
    EXPECT_EQ(
        error_of({write("scene.xml", in_scene("<shape type='cubes'/>")), {}, true}).substr(0, 44),
        "scene.xml:2:14: error: unknown plugin 'cubes");
}

} // namespace
} // namespace plumb::test
