/// \file  What two intersectors' answers to one ray are to each other.
#pragma once

#include "accel/intersector.h"

#include <atomic>

namespace plumb {

/// From equal to wrong. Up to and including `boundary` a disagreement is explained.
enum class Agreement : std::uint8_t {
    equal,       ///< the same bits (-0 is 0)
    ulps,        ///< the same primitive; t, u and v within the referee's bounds, or 8 ulp
    tie,         ///< another primitive at the same t: coplanar or duplicate geometry
    shared_edge, ///< another primitive at the same t, with a corner in common that the ray is
                 ///< beside
    range,       ///< tmin or tmax lies at the hit within rounding
    boundary,    ///< the ray passes an outline within rounding: hit or miss, either is right
    inexact,     ///< t, u or v is off by more than the bound
    miss,        ///< a hit that certainly exists was not found
    false_hit,   ///< a hit that certainly does not exist was found
    leak,        ///< nothing was found beside an edge or corner around which the surface goes on
};
inline constexpr std::size_t agreement_count = 10;

[[nodiscard]] constexpr bool is_explained(Agreement a) { return a <= Agreement::boundary; }
[[nodiscard]] std::string_view name_of(Agreement agreement);

/// Which of the two intersectors is wrong; `none` where both are right.
enum class Culprit : std::uint8_t { none, first, second, both };
[[nodiscard]] std::string_view name_of(Culprit culprit);

struct Verdict {
    Agreement agreement = Agreement::equal;
    Culprit culprit = Culprit::none;
    /// The same primitive beyond 8 ulp: how far the t that is farther off is from the referee's, in
    /// units of the bound.
    double share_of_bound = 0;
};

/// The two answers to one ray. Any-hit queries fill the hits with what closest() says, which tells
/// the primitive concerned.
struct Answers {
    Hit first, second;
    bool any_hit = false;                           ///< the query was occluded()
    bool first_found = false, second_found = false; ///< what occluded() said
};

/// Same bits, -0 being equal to 0.
[[nodiscard]] bool is_equal(const Hit& a, const Hit& b);

/// Floats between a and b, -0 and 0 being one; the largest number where one is not a number.
[[nodiscard]] std::uint64_t ulps_between(float a, float b);

/// Classifies disagreements by the referee. Safe to call from any number of threads.
class Classifier {
  public:
    /// `geometry` and both intersectors, built over it, must outlive it. `scan_budget`: primitives
    /// that scans (of the neighbours of a possible leak, mostly) may look at, all together. After
    /// that a possible leak counts as `boundary`, and in unchecked().
    Classifier(GeometryView geometry, const Intersector& first, const Intersector& second,
               std::uint64_t scan_budget = std::uint64_t{1} << 35u);

    [[nodiscard]] Verdict closest(const Ray& ray, const Hit& first, const Hit& second) const;
    /// Answers to occluded(). Fills in the hits with closest() where the two disagree.
    [[nodiscard]] Verdict occluded(const Ray& ray, Answers& answers) const;

    /// Disagreements that were judged without a scan.
    [[nodiscard]] std::uint64_t unchecked() const { return unchecked_; }

  private:
    [[nodiscard]] Verdict same_primitive(const Ray& ray, const Hit& first, const Hit& second) const;
    [[nodiscard]] Verdict not_found(const Ray& ray, const Hit& hit, const Intersector& finder,
                                    float limit, Culprit loser) const;
    [[nodiscard]] bool may_scan() const;

    GeometryView geometry_;
    const Intersector &first_, &second_;
    std::uint64_t scan_budget_;
    mutable std::atomic<std::uint64_t> scanned_{0}, unchecked_{0};
};

} // namespace plumb
