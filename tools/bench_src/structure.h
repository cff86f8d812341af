/// \file  One built structure, and the loops that trace rays through it.
#pragma once

#include "accel/embree/embree_peer.h"
#include "tools/bench_src/config.h"
#include "tools/bench_src/ray_sets.h"

#include <optional>

namespace plumb::bench {

/// Rays in one call of closest(span): what a renderer has at hand in a tile.
inline constexpr std::size_t stream_size = 256;

/// One pass over a set of rays.
struct Pass {
    double cpu_s = 0;           ///< of the thread; on a GPU the time of the kernel
    std::uint64_t checksum = 0; ///< of the answers
};

/// The Intersector or Embree's scene of one StructureConfig.
class Structure {
  public:
    /// `view` must outlive the structure. Nothing is built yet.
    Structure(const StructureConfig& config, GeometryView view) : config_(config), view_(view) {}

    /// Builds, or builds again. Throws what make_intersector and EmbreeScene throw.
    void build();

    [[nodiscard]] const StructureConfig& config() const { return config_; }
    /// Of each build: CPU time of the process where it has one thread, else wall time. Embree's is
    /// that of its commits, without copying the vertices into its buffers.
    [[nodiscard]] const std::vector<double>& build_s() const { return build_s_; }
    [[nodiscard]] AccelStats stats() const; ///< of Embree: the bytes alone
    [[nodiscard]] TraversalCounts count(const RaySet& rays) const;

    /// Rays in the form that the loop wants; `wide` as in Config.
    struct Prepared {
        const RaySet* rays = nullptr; ///< must outlive it
        bool wide = false;
        std::optional<EmbreeRays> embree;
    };
    [[nodiscard]] Prepared prepare(const RaySet& rays, bool wide) const;

    /// The pass that is timed.
    [[nodiscard]] Pass trace(const Prepared& prepared) const;

    /// The same queries, answers kept: one for each ray. Any-hit queries give an anonymous hit
    /// (t, geometry and primitive 0) or a miss. Returns the checksum that every trace() must give.
    [[nodiscard]] std::uint64_t answers(const Prepared& prepared, std::span<Hit> hits) const;

  private:
    Pass trace_on_cuda(const RaySet& rays, std::span<Hit> hits) const;

    StructureConfig config_;
    GeometryView view_;
    std::unique_ptr<Intersector> own_;
    std::unique_ptr<EmbreePeer> embree_;
    std::unique_ptr<RayTracer> cuda_;
    mutable const RaySet* loaded_ = nullptr; ///< the set that cuda_ has
    std::vector<double> build_s_;
};

} // namespace plumb::bench
