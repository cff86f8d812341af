/// \file  A whole render as one file: what kernels read, the settings, and what must come of it.
///
/// For machines that have a compiler and a GPU and nothing else: no parser, no mesh reader. Numbers
/// are written as they lie in memory; the head of the file holds the sizes of all records, so that
/// a program with other ones refuses it.
#pragma once

#include "renderer/integrate/pixel.h"

#include <filesystem>
#include <string>
#include <vector>

namespace plumb {

struct FlatMesh {
    std::vector<Vec3> positions, normals; ///< normals: none, or one a vertex
    std::vector<Triangle> triangles;
};

/// A RenderJob that owns what its views look at, apart from trees, which are built anew.
struct FlatScene {
    std::string name;
    std::vector<FlatMesh> meshes;
    std::vector<Sphere> spheres;
    std::vector<Surface> surfaces;
    std::vector<SurfaceLights> surface_lights;
    std::vector<Material> materials;
    std::vector<Light> lights;
    std::vector<float> light_cdf;
    RenderJob settings; ///< scene: camera and environment only
    Features needed;
    TriangleTest triangle_test = TriangleTest::watertight;

    std::uint64_t image_hash = 0; ///< what the CPU rendered
    RayCounts rays;               ///< and traced
};

/// Copies all that `job` points to.
[[nodiscard]] FlatScene flatten(std::string name, const RenderJob& job, const Features& needed);

[[nodiscard]] std::string to_bytes(const FlatScene& scene);
/// Throws std::runtime_error, which names what is wrong, for bytes that to_bytes did not write or
/// that are cut short.
[[nodiscard]] FlatScene from_bytes(std::string_view bytes);

/// The same with files; throw std::runtime_error that names the file.
void write_flat(const std::filesystem::path& file, const FlatScene& scene);
[[nodiscard]] FlatScene read_flat(const std::filesystem::path& file);

/// The job of a flat scene, which must outlive it unchanged.
class FlatJob {
  public:
    explicit FlatJob(const FlatScene& scene);
    FlatJob(const FlatJob&) = delete;
    FlatJob& operator=(const FlatJob&) = delete;

    [[nodiscard]] const RenderJob& job() const { return job_; }

  private:
    std::vector<MeshView> meshes_;
    std::vector<std::span<const Vec3>> normals_;
    RenderJob job_;
};

} // namespace plumb
