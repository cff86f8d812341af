#include "cuda/flat_scene.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <type_traits>

namespace plumb {
namespace {

constexpr std::string_view magic = "plumbline flat scene 1\n";

/// Sizes of the records that are written as they lie in memory.
constexpr std::uint32_t record_sizes[] = {
    sizeof(Vec3),          sizeof(Triangle),     sizeof(Sphere),          sizeof(Surface),
    sizeof(SurfaceLights), sizeof(Material),     sizeof(Light),           sizeof(Camera),
    sizeof(FilterTable),   sizeof(PathSettings), sizeof(SamplerSettings), sizeof(Crop),
    sizeof(Features),      sizeof(RayCounts)};

class Writer {
  public:
    template <class T> void value(const T& v) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes_.append(reinterpret_cast<const char*>(&v), sizeof(T));
    }
    template <class Array> void array(const Array& a) {
        const std::uint64_t size = a.size();
        value(size);
        bytes_.append(reinterpret_cast<const char*>(a.data()),
                      a.size() * sizeof(typename Array::value_type));
    }
    void text(std::string_view text) { bytes_ += text; }
    void count(const std::vector<FlatMesh>& a) {
        const std::uint64_t size = a.size();
        value(size);
    }
    [[nodiscard]] std::string bytes() && { return std::move(bytes_); }

  private:
    std::string bytes_;
};

class Reader {
  public:
    explicit Reader(std::string_view bytes) : left_(bytes) {}

    template <class T> void value(T& v) {
        static_assert(std::is_trivially_copyable_v<T>);
        std::memcpy(&v, take(sizeof(T)).data(), sizeof(T));
    }
    template <class Array> void array(Array& a) {
        using T = typename Array::value_type;
        const std::uint64_t size = number();
        if (size > left_.size() / sizeof(T))
            throw std::runtime_error("the file is cut short");
        a.resize(size);
        if (size > 0)
            std::memcpy(a.data(), take(size * sizeof(T)).data(), size * sizeof(T));
    }
    void count(std::vector<FlatMesh>& a) {
        const std::uint64_t size = number();
        if (size > left_.size())
            throw std::runtime_error("the file is cut short");
        a.resize(size);
    }
    std::string_view take(std::size_t size) {
        if (size > left_.size())
            throw std::runtime_error("the file is cut short");
        const std::string_view taken = left_.substr(0, size);
        left_.remove_prefix(size);
        return taken;
    }
    [[nodiscard]] bool at_end() const { return left_.empty(); }

  private:
    std::uint64_t number() {
        std::uint64_t n = 0;
        value(n);
        return n;
    }

    std::string_view left_;
};

/// One order for both directions. `Scene`: FlatScene, const where it is written.
template <class Archive, class Scene> void transfer(Archive& file, Scene& s) {
    file.array(s.name);
    file.count(s.meshes);
    for (auto& mesh : s.meshes) {
        file.array(mesh.positions);
        file.array(mesh.normals);
        file.array(mesh.triangles);
    }
    file.array(s.spheres);
    file.array(s.surfaces);
    file.array(s.surface_lights);
    file.array(s.materials);
    file.array(s.lights);
    file.array(s.light_cdf);
    auto& job = s.settings;
    file.value(job.scene.environment);
    file.value(job.scene.camera);
    file.value(job.filter);
    file.value(job.path);
    file.value(job.sampler);
    file.value(job.width);
    file.value(job.height);
    file.value(job.crop);
    file.value(s.needed);
    file.value(s.triangle_test);
    file.value(s.image_hash);
    file.value(s.rays);
}

template <class T> std::vector<T> copy_of(std::span<const T> from) {
    return {from.begin(), from.end()};
}

/// What indexes into what: a file that was tampered with must not lead outside.
void check(const FlatScene& s) {
    const auto require = [](bool holds) {
        if (!holds)
            throw std::runtime_error("the scene contradicts itself");
    };
    const std::size_t surfaces = s.meshes.size() + s.spheres.size();
    require(s.surfaces.size() == surfaces && s.surface_lights.size() == surfaces);
    require(s.light_cdf.size() == (s.lights.empty() ? 0 : s.lights.size() + 1));
    for (const FlatMesh& mesh : s.meshes) {
        require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
        for (const Triangle& t : mesh.triangles)
            require(std::max({t.a, t.b, t.c}) < mesh.positions.size());
    }
    for (const Surface& surface : s.surfaces)
        for (const std::uint32_t material : {surface.front, surface.back})
            require(material == invalid_id || material < s.materials.size());
    for (const SurfaceLights& lights : s.surface_lights)
        require(lights.first == invalid_id || lights.first < s.lights.size());
    const Crop& crop = s.settings.crop;
    require(crop.width > 0 && crop.height > 0 && s.settings.sampler.spp > 0);
}

} // namespace

FlatScene flatten(std::string name, const RenderJob& job, const Features& needed) {
    FlatScene flat;
    flat.name = std::move(name);
    const SceneView& scene = job.scene;
    for (std::size_t i = 0; i < scene.geometry.meshes.size(); ++i)
        flat.meshes.push_back({copy_of(scene.geometry.meshes[i].positions),
                               copy_of(scene.normals[i]),
                               copy_of(scene.geometry.meshes[i].triangles)});
    flat.spheres = copy_of(scene.geometry.spheres);
    flat.surfaces = copy_of(scene.surfaces);
    flat.surface_lights = copy_of(scene.surface_lights);
    flat.materials = copy_of(scene.materials);
    flat.lights = copy_of(scene.lights);
    flat.light_cdf = copy_of(scene.light_cdf);
    flat.settings = job;
    flat.settings.scene = {};
    flat.settings.scene.environment = scene.environment;
    flat.settings.scene.camera = scene.camera;
    flat.needed = needed;
    return flat;
}

std::string to_bytes(const FlatScene& scene) {
    Writer file;
    file.text(magic);
    file.value(record_sizes);
    transfer(file, scene);
    return std::move(file).bytes();
}

FlatScene from_bytes(std::string_view bytes) {
    Reader file(bytes);
    if (!bytes.starts_with(magic))
        throw std::runtime_error("not a flat scene");
    file.take(magic.size());
    std::uint32_t there[std::size(record_sizes)];
    file.value(there);
    if (std::memcmp(there, record_sizes, sizeof(there)) != 0)
        throw std::runtime_error("a flat scene of another version of the program");
    FlatScene scene;
    transfer(file, scene);
    if (!file.at_end())
        throw std::runtime_error("more bytes than a flat scene has");
    check(scene);
    return scene;
}

void write_flat(const std::filesystem::path& file, const FlatScene& scene) {
    const std::string bytes = to_bytes(scene);
    std::ofstream out(file, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.flush();
    if (!out)
        throw std::runtime_error(file.string() + ": cannot be written");
}

FlatScene read_flat(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in)
        throw std::runtime_error(file.string() + ": cannot be opened");
    std::ostringstream content;
    content << in.rdbuf();
    try {
        return from_bytes(content.view());
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(file.string() + ": " + error.what());
    }
}

FlatJob::FlatJob(const FlatScene& scene) : job_(scene.settings) {
    for (const FlatMesh& mesh : scene.meshes) {
        meshes_.push_back({mesh.positions, mesh.triangles});
        normals_.emplace_back(mesh.normals);
    }
    SceneView& view = job_.scene;
    view.geometry = {meshes_, scene.spheres};
    view.normals = normals_;
    view.surfaces = scene.surfaces;
    view.surface_lights = scene.surface_lights;
    view.materials = scene.materials;
    view.lights = scene.lights;
    view.light_cdf = scene.light_cdf;
}

} // namespace plumb
