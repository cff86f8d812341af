/// \file  Two intersectors over the same rays: answers with the first, compares with the second.
#pragma once

#include "accel/validate/classify.h"

#include <array>
#include <functional>
#include <vector>

namespace plumb {

enum class RayKind : std::uint8_t { camera, bounce, shadow };
inline constexpr std::size_t ray_kind_count = 3;
[[nodiscard]] std::string_view name_of(RayKind kind);

/// A ray about which the two disagree.
struct Disagreement {
    Ray ray;
    RayKind kind = RayKind::bounce;
    Verdict verdict;
    Answers answers;
};

/// Differences of 0, 1, 2, 3-4, 5-8 and 9 or more ulp.
using UlpHistogram = std::array<std::uint64_t, 6>;
inline constexpr std::array<std::string_view, 6> ulp_bin_names{"0", "1", "2", "3-4", "5-8", "9+"};

/// What a validation found.
struct ValidationReport {
    std::array<std::uint64_t, ray_kind_count> rays{}; ///< by RayKind
    /// Rays by Agreement and Culprit.
    std::array<std::array<std::uint64_t, 4>, agreement_count> counts{};
    /// Where both hit the same primitive with other bits: t in ulps of t, the larger of u and v in
    /// ulps of 1 (2^-23).
    UlpHistogram t_ulps{}, uv_ulps{};
    std::uint64_t worst_t_ulps = 0, worst_uv_ulps = 0; ///< of the explained ones
    double worst_share = 0;      ///< largest Verdict::share_of_bound of the explained ones
    std::uint64_t unchecked = 0; ///< see Classifier::unchecked
    std::vector<Disagreement> unexplained, explained; ///< as many as were kept

    [[nodiscard]] std::uint64_t ray_count() const;
    [[nodiscard]] std::uint64_t count(Agreement agreement) const;
    [[nodiscard]] std::uint64_t unexplained_count() const;
};

struct ValidationOptions {
    std::size_t keep_unexplained = 10000; ///< disagreements kept of each sort; counts know no limit
    std::size_t keep_explained = 0;       ///< `ulps` of at most 8 is never kept
    /// Tells camera rays from bounces; without it all closest-hit rays are bounces.
    std::function<bool(const Ray&)> is_camera_ray;
};

/// An Intersector that answers with the hits of `first`, streams included, while it has `second`
/// trace the same rays the same way and classifies each disagreement. Any number of threads; memory
/// is bounded by the options. Of more disagreements than are kept it keeps those with the smallest
/// hash: the same ones for any number of threads.
class ValidatingIntersector final : public Intersector {
  public:
    /// Both intersectors stand over `geometry`; all must outlive it.
    ValidatingIntersector(GeometryView geometry, const Intersector& first,
                          const Intersector& second, ValidationOptions options = {});
    ~ValidatingIntersector() override;

    [[nodiscard]] Hit closest(const Ray& ray) const override;
    [[nodiscard]] bool occluded(const Ray& ray) const override;
    void closest(std::span<const Ray> rays, std::span<Hit> hits) const override;
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> found) const override;
    [[nodiscard]] TraversalCounts count(std::span<const Ray> rays, bool any_hit) const override;
    [[nodiscard]] AccelStats stats() const override; ///< of the first

    /// What was found so far; call it when no ray is on its way.
    [[nodiscard]] ValidationReport report() const;

  private:
    struct Shard;
    struct Kept;
    void compare_closest(const Ray& ray, const Hit& first, const Hit& second) const;
    void compare_occluded(const Ray& ray, bool first, bool second) const;
    void note(const Ray& ray, RayKind kind, const Verdict& verdict, const Answers& answers) const;
    [[nodiscard]] Shard& shard() const;

    const Intersector &first_, &second_;
    ValidationOptions options_;
    Classifier classifier_;
    std::unique_ptr<Shard[]> shards_;
    std::unique_ptr<Kept> unexplained_, explained_;
};

} // namespace plumb
