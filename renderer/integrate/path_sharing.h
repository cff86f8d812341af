/// \file  Pixels of a block share their paths from the second vertex on.
///
/// What leaves the second vertex of a path could have come to the first vertex of each path of a
/// small block of pixels. So it counts for all of them, weighted by the balance heuristic over the
/// densities with which each could have chosen that vertex, itself included: no weight is above
/// one, and every pixel's mean stays what it was. A visibility ray for each other path pays for as
/// many more ends of paths a pixel. P. Bekaert, M. Sbert, J. Halton, "Accelerating Path Tracing by
/// Re-Using Paths", Rendering Techniques 2002. The errors of a block's pixels are alike in turn.
#pragma once

#include "accel/intersector.h"
#include "renderer/integrate/path_lanes.h"

namespace plumb {

/// The most pixels that share paths, 4 x 4.
inline constexpr std::size_t max_sharing = 16;

/// What is shared of a batch of paths, each at the slot where it was added.
class PathSharing {
  public:
    /// For a new batch.
    void clear(std::size_t count);
    /// Paths since the last group's end, up to slot `end`, one of each pixel of a block, share
    /// what they find. At most max_sharing; paths in no group share nothing.
    void end_group(std::size_t end);

    /// The first vertex of a path, in lane i, from which it was sent on.
    void leave_first(const PathLanes& lanes, const Vec3Lanes& shading, std::size_t i);
    /// Its throughput there; that of the shared rest starts at one.
    void set_own(std::size_t slot, Rgb throughput) { own_.set(slot, throughput); }
    [[nodiscard]] Rgb own(std::size_t slot) const { return own_[slot]; }
    /// The second vertex, in lane i. `alike`: what it reflects does not depend on whence it is seen
    /// on that side.
    void reach_second(const PathLanes& lanes, std::size_t i, bool alike);
    /// Radiance that leaves the second vertex towards the first.
    void add(std::size_t slot, Rgb radiance) { tail_.set(slot, tail_[slot] + radiance); }

    /// Adds to lanes.radiance what the paths found after their second vertices. Overwrites the
    /// lanes' rays. Returns the number of visibility rays.
    std::size_t share(const Intersector& intersector, HemisphereSampling hemisphere,
                      PathLanes& lanes);

  private:
    struct Vertices {
        Vec3Lanes position, error, normal; ///< geometric, on the side of the path
    };
    /// How first vertex k comes to the second vertex of t: per area there, without visibility.
    struct Connection {
        float density;   ///< of choosing it
        float reflected; ///< BRDF times both cosines over the squared distance, for reflectance 1
    };
    [[nodiscard]] Connection connect(std::size_t k, std::size_t t,
                                     HemisphereSampling hemisphere) const;
    [[nodiscard]] Ray visibility_ray(std::size_t k, std::size_t t) const;
    void trace(const Intersector& intersector, std::size_t count, PathLanes& lanes);
    void distribute(std::size_t first, std::size_t end, PathLanes& lanes) const;

    Vertices first_, second_;
    Vec3Lanes shading_; ///< normals of the first vertices
    RgbLanes reflectance_, own_, tail_;
    FlagLanes left_;  ///< whether the path could be sent on from its first vertex
    FlagLanes alike_; ///< of the second vertex
    Lanes<std::uint32_t> group_end_;
    std::size_t groups_ = 0;
    Connection connection_[max_lanes][max_sharing]; ///< [t][k of its group]
    std::uint32_t asked_[max_lanes]; ///< of each visibility ray: max_sharing t + k of its group
};

} // namespace plumb
