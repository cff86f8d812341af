#include "tests/support/box_scenes.h"

namespace plumb::test {
namespace {

/// The words in which the two dialects differ.
struct Words {
    std::string version, to_world, lookat, film, sample_count;
};

const Words version3{"3.0.0", "to_world", "lookat", "hdrfilm", "sample_count"};
const Words version06{"0.6.0", "toWorld", "lookAt", "hdrfilm", "sampleCount"};

std::string head(const Words& w) {
    return R"(<scene version=")" + w.version + R"(">
<default name="side" value="32"/><default name="spp" value="16"/><default name="seed" value="0"/>
<default name="sampler" value="independent"/>
<integrator type="path"/>
<sensor type="perspective"><float name="fov" value="39"/>
<transform name=")" +
           w.to_world + R"("><)" + w.lookat +
           R"( origin="0.2, 0.1, 3.9" target="0, 0, 0" up="0, 1, 0"/>
</transform>
<film type=")" +
           w.film + R"("><integer name="width" value="$side"/><integer name="height" value="$side"/>
<rfilter type="tent"/></film>
<sampler type="$sampler"><integer name=")" +
           w.sample_count + R"(" value="$spp"/><integer name="seed" value="$seed"/></sampler>
</sensor>
<bsdf type="twosided" id="white"><bsdf type="diffuse">
<rgb name="reflectance" value="0.75, 0.7, 0.65"/></bsdf></bsdf>
<bsdf type="twosided" id="red"><bsdf type="diffuse">
<rgb name="reflectance" value="0.6, 0.1, 0.05"/></bsdf></bsdf>
<bsdf type="diffuse" id="green"><rgb name="reflectance" value="0.15, 0.5, 0.1"/></bsdf>
)";
}

std::string element(const Words& w, const std::string& type, const std::string& transform,
                    const std::string& inside) {
    return R"(<shape type=")" + type + R"("><transform name=")" + w.to_world + R"(">)" + transform +
           "</transform>" + inside + "</shape>\n";
}

std::string walls(const Words& w) {
    const std::string white = R"(<ref id="white"/>)";
    return element(w, "rectangle", R"(<rotate x="1" angle="-90"/><translate y="-1"/>)", white) +
           element(w, "rectangle", R"(<rotate x="1" angle="90"/><translate y="1"/>)", white) +
           element(w, "rectangle", R"(<translate z="-1"/>)", white) +
           element(w, "rectangle", R"(<rotate y="1" angle="90"/><translate x="-1"/>)",
                   R"(<ref id="red"/>)") +
           element(w, "rectangle", R"(<rotate y="1" angle="-90"/><translate x="1"/>)",
                   R"(<ref id="green"/>)") +
           element(w, "cube",
                   R"(<scale x="0.3" y="0.6" z="0.25"/><rotate y="1" angle="20"/>)"
                   R"(<translate x="-0.35" y="-0.4" z="-0.3"/>)",
                   white);
}

std::string lamp(const Words& w) {
    return element(w, "rectangle",
                   R"(<scale x="0.5" y="0.4"/><rotate x="1" angle="95"/>)"
                   R"(<translate x="0.05" y="0.94"/>)",
                   R"(<ref id="white"/><emitter type="area">)"
                   R"(<rgb name="radiance" value="7, 5, 3"/></emitter>)");
}

std::string plain(const Words& w) { return head(w) + walls(w) + lamp(w) + "</scene>\n"; }

} // namespace

std::string plain_box() { return plain(version3); }

std::string plain_box_in_dialect_06() { return plain(version06); }

std::string rich_box() {
    const Words& w = version3;
    return head(w) + walls(w) + lamp(w) +
           element(w, "sphere", R"(<scale value="0.35"/><translate x="0.4" y="-0.65" z="0.3"/>)",
                   R"(<ref id="white"/>)") +
           element(w, "disk",
                   R"(<scale value="0.3"/><rotate y="1" angle="70"/>)"
                   R"(<translate x="-0.9" y="0.3" z="0.4"/>)",
                   R"(<ref id="red"/><emitter type="area">)"
                   R"(<rgb name="radiance" value="2, 4, 6"/></emitter>)") +
           R"(<emitter type="point"><point name="position" value="0.5, 0.2, 0.6"/>
<rgb name="intensity" value="0.4, 0.3, 0.2"/></emitter>
<emitter type="constant"><rgb name="radiance" value="0.2, 0.3, 0.4"/></emitter>
</scene>
)";
}

} // namespace plumb::test
