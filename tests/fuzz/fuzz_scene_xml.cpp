/// \file  Any bytes as a scene file.

#include "renderer/integrate/render.h"
#include "renderer/io/load_scene.h"
#include "renderer/scene/features.h"
#include "renderer/scene/scene_tables.h"
#include "tests/fuzz/finding.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/mesh_checks.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <unistd.h>

namespace plumb::fuzz {
namespace {

namespace fs = std::filesystem;

/// The folder in which the scene lies, with files that it may name. Removed at the end.
class SceneFolder {
  public:
    SceneFolder()
        : path_(fs::temp_directory_path() / ("plumb_fuzz_" + std::to_string(::getpid()))) {
        fs::create_directories(path_ / "b");
        write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 2 3 4\n");
        write("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
                       "y\nproperty float z\nelement face 1\nproperty list uchar int "
                       "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
        write("a.xml", "<scene version='3.0.0'><bsdf type='diffuse' id='a'/></scene>");
        write("b/a.xml", "<shape type='sphere'><ref id='a'/></shape>");
    }
    ~SceneFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    SceneFolder(const SceneFolder&) = delete;
    SceneFolder& operator=(const SceneFolder&) = delete;

    fs::path write(const char* name, std::string_view content) const {
        std::ofstream(path_ / name, std::ios::binary) << content;
        return path_ / name;
    }

  private:
    fs::path path_;
};

std::optional<Scene> load_or_refuse(const fs::path& file, bool lenient) {
    try {
        return load_scene({file, {{"p", "1"}}, lenient});
    } catch (const SceneError& error) {
        require(error.kind() == ErrorKind::scene || error.kind() == ErrorKind::mesh,
                "a scene that is not refused as a scene or a mesh");
        require_well_formed(error);
        return std::nullopt;
    }
}

bool is_within(Rgb c, float low, float high) {
    return c.r >= low && c.r <= high && c.g >= low && c.g <= high && c.b >= low && c.b <= high;
}

/// What the kernels take for granted.
void require_sound(const Scene& scene) {
    require(scene.surfaces.size() == scene.meshes.size() + scene.spheres.size(),
            "surfaces, not one a shape");
    constexpr float largest = std::numeric_limits<float>::max();
    for (const Surface& s : scene.surfaces) {
        for (const std::uint32_t side : {s.front, s.back})
            require(side == invalid_id || side < scene.materials.size(), "a material out of range");
        require(is_within(s.emission, 0, largest), "an emission out of range");
    }
    for (const Material& m : scene.materials)
        require(is_within(m.reflectance, 0, 1), "a reflectance out of range");
    for (const PointLight& light : scene.point_lights)
        require(is_finite(light.position) && is_within(light.intensity, 0, largest),
                "a point light out of range");
    require(is_within(scene.environment, 0, largest), "an environment out of range");
    for (const Mesh& mesh : scene.meshes)
        require(std::all_of(mesh.positions.begin(), mesh.positions.end(), is_finite),
                "a mesh out of range");
    const FilmSettings& film = scene.film;
    require(film.width >= 1 && film.width <= 65536 && film.height >= 1 && film.height <= 65536,
            "a film out of range");
    require(film.crop.x >= 0 && film.crop.y >= 0 && film.crop.width >= 1 && film.crop.height >= 1 &&
                film.crop.x + film.crop.width <= film.width &&
                film.crop.y + film.crop.height <= film.height,
            "a crop out of range");
    require(scene.sampler.spp >= 1, "a scene without samples");
}

/// A few pixels of the image, by the very steps of the program.
void require_no_nan(Scene& scene) {
    scene.film.crop.width = std::min(scene.film.crop.width, 3);
    scene.film.crop.height = std::min(scene.film.crop.height, 2);
    scene.sampler.spp = std::min(scene.sampler.spp, 2u);
    const SceneTables tables(scene);
    BuildOptions build;
    build.threads = 1;
    const auto intersector = make_intersector(AccelKind::sah, tables.geometry(), build);
    RenderOptions how;
    how.threads = 1;
    RenderStats stats;
    const Image image =
        render(make_job(scene, tables.view()), features_of(scene), *intersector, how, stats)
            .resolve();
    require(std::none_of(image.pixels.begin(), image.pixels.end(),
                         [](Rgb p) { return std::isnan(p.r + p.g + p.b); }),
            "an image with a NaN");
}

} // namespace

int fuzz_scene_xml(const std::uint8_t* data, std::size_t size) {
    static const SceneFolder folder;
    const std::string text(data, data + size);
    const fs::path file = folder.write("scene.xml", text);
    std::optional<Scene> strict = load_or_refuse(file, false);
    const std::optional<Scene> lenient = load_or_refuse(file, true);
    if (lenient)
        require_sound(*lenient);
    if (strict) {
        require(lenient.has_value(), "--lenient refuses what is loaded without it");
        require(lenient->meshes.size() == strict->meshes.size() &&
                    lenient->spheres.size() == strict->spheres.size() &&
                    lenient->ignored == strict->ignored,
                "--lenient changes a scene that needs no substitute");
        require_sound(*strict);
        require_no_nan(*strict);
    }
    return 0;
}

} // namespace plumb::fuzz
