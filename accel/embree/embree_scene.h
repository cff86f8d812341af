/// \file  A built Embree scene over a GeometryView.
#pragma once

#include "accel/embree/embree_options.h"

#include <memory>
#include <string>

namespace plumb {

/// Meshes keep their index as geometry id; all spheres are one user geometry that calls
/// intersect_sphere. The view must outlive the scene.
class EmbreeScene {
  public:
    /// Throws std::bad_alloc where memory ends and std::runtime_error for Embree's other errors.
    EmbreeScene(const GeometryView& geometry, const EmbreeOptions& options);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    [[nodiscard]] void* handle() const; ///< Embree's handle of the scene
    /// What Embree itself took, without the copying of vertices into its buffers: wall time.
    [[nodiscard]] double commit_s() const;
    /// The same as CPU time of all threads.
    [[nodiscard]] double commit_cpu_s() const;
    [[nodiscard]] std::size_t bytes() const; ///< held for Embree now, its copies of vertices too

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// For example `3.13.5`.
[[nodiscard]] std::string embree_version();

} // namespace plumb
