/// \file  Traces the rays of a replay file again, with its geometry alone.
#pragma once

#include "accel/validate/replay.h"

#include <iosfwd>

namespace plumb {

struct ReplayOutcome {
    std::size_t rays = 0;
    std::size_t reproduced = 0;  ///< both sides give again the answers in the file, bit for bit
    std::size_t unexplained = 0; ///< rays about which the pair's disagreement, as found now, is
};

/// The geometry of a replay as intersectors want it. Ids are dense: a geometry and a primitive of
/// the scene become the next free ones, in the same order, so that ties fall the same way.
class ReplayGeometry {
  public:
    /// `replay` must outlive it.
    explicit ReplayGeometry(const Replay& replay);
    ReplayGeometry(const ReplayGeometry&) = delete;
    ReplayGeometry& operator=(const ReplayGeometry&) = delete;

    [[nodiscard]] GeometryView view() const { return {meshes_, spheres_}; }
    /// A hit of view() with the ids of the scene, and the other way round. What is not here, a miss
    /// among it, stays a miss.
    [[nodiscard]] Hit to_scene(Hit hit) const;
    [[nodiscard]] Hit from_scene(Hit hit) const;

  private:
    const Replay& replay_;
    std::vector<std::size_t> first_; ///< of each geometry in replay.primitives; one more at the end
    std::vector<Vec3> positions_;
    std::vector<Triangle> triangles_;
    std::vector<MeshView> meshes_;
    std::vector<Sphere> spheres_;
};

/// Builds naive, sah (each instruction set that there is) and Embree over the replay's primitives,
/// traces each ray through all of them and prints, a block a ray: what each answers, what the file
/// says that the pair answered, the referee's opinion of each primitive concerned, and whether the
/// disagreement is there again with these primitives alone. A last line sums up.
ReplayOutcome run_replay(const Replay& replay, std::ostream& out);

} // namespace plumb
