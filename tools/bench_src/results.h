/// \file  What the benchmark measured, and the ratios made of it.
#pragma once

#include "accel/intersector.h"
#include "tools/bench_src/config.h"
#include "tools/bench_src/ray_sets.h"

#include <optional>

namespace plumb::bench {

/// One configuration on one set of rays.
struct Entry {
    std::string config;
    bool embree = false, robust = false, wide = false;
    std::vector<double> mrays_s; ///< of each repetition
    std::uint64_t wrong = 0;     ///< rays whose answer is not the reference's
    TraversalCounts counts;      ///< over all rays; zeros where unknown

    [[nodiscard]] double median() const;
};

/// All configurations on one set of rays of one mesh, interleaved.
struct Cell {
    std::string mesh;
    RayKind kind = RayKind::primary;
    std::size_t rays = 0, hits = 0; ///< hits: of the reference
    std::vector<Entry> entries;

    /// Median Mrays/s of the fastest Embree: single rays not robust, single rays robust, packets of
    /// either. 0 where none ran.
    [[nodiscard]] double best_default() const;
    [[nodiscard]] double best_robust() const;
    [[nodiscard]] double best_packet() const;
};

struct BuildResult {
    std::string structure;
    std::vector<double> build_s;
    AccelStats stats;

    [[nodiscard]] double median_s() const;
};

struct MeshResult {
    std::string name;
    std::size_t triangles = 0;
    std::uint64_t hash = 0;
    std::vector<BuildResult> builds;
    std::vector<Cell> cells;

    [[nodiscard]] double mtriangles_s(const BuildResult& build) const;
    [[nodiscard]] double bytes_per_triangle(const BuildResult& build) const;
};

/// Ratios of one configuration on one kind of rays, over all meshes where both ran.
struct Ratio {
    double geometric_mean = 0;
    double least = 0;
    std::string least_mesh;
    std::size_t cells = 0;
};
struct SummaryRow {
    std::string config;
    RayKind kind = RayKind::primary;
    std::optional<Ratio> to_default, to_robust, to_packet; ///< empty where no such Embree ran
};

/// A row for each configuration that is not Embree's and each kind of rays it ran on. Streams are
/// compared with packets, too.
[[nodiscard]] std::vector<SummaryRow> summary_of(const std::vector<MeshResult>& meshes);

/// The middle one, the mean of the two in the middle, or 0 of nothing.
[[nodiscard]] double median_of(std::vector<double> values);

/// value / base, or nothing where base is 0.
[[nodiscard]] std::optional<double> ratio_of(double value, double base);

} // namespace plumb::bench
