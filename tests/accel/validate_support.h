/// \file  What the tests of the validation share: an intersector with a defect.
#pragma once

#include "accel/validate/validating_intersector.h"
#include "tests/accel/intersector_suite.h"

#include <utility>

namespace plumb {

inline void PrintTo(const Verdict& v, std::ostream* out) {
    *out << name_of(v.agreement) << ", wrong: " << name_of(v.culprit);
}
inline bool operator==(const Verdict& a, const Verdict& b) {
    return a.agreement == b.agreement && a.culprit == b.culprit;
}

} // namespace plumb

namespace plumb::test {

/// Answers as another intersector does, with a defect put over it.
class Defective final : public Intersector {
  public:
    using Defect = std::function<Hit(const Ray&, Hit)>;

    Defective(const Intersector& sound, Defect defect)
        : sound_(sound), defect_(std::move(defect)) {}

    using Intersector::closest;
    using Intersector::occluded;
    [[nodiscard]] Hit closest(const Ray& ray) const override {
        return defect_(ray, sound_.closest(ray));
    }
    [[nodiscard]] bool occluded(const Ray& ray) const override { return closest(ray).valid(); }
    [[nodiscard]] AccelStats stats() const override { return sound_.stats(); }

  private:
    const Intersector& sound_;
    Defect defect_;
};

inline Hit miss_always(const Ray& /*ray*/, const Hit& /*hit*/) { return {}; }

/// A float moved by so many ulps.
inline float moved(float x, int ulps) {
    for (int i = 0; i < std::abs(ulps); ++i)
        x = std::nextafter(x, ulps > 0 ? infinity : -infinity);
    return x;
}

/// What a validation of the sound naive tree against a defective copy says of one ray.
struct Case {
    TestGeometry geometry;
    Ray ray;
    Defective::Defect defect;

    [[nodiscard]] Verdict closest() const { return run(false, false).verdict; }
    [[nodiscard]] Verdict occluded() const { return run(true, false).verdict; }
    /// The defective one in the place of the first.
    [[nodiscard]] Verdict closest_swapped() const { return run(false, true).verdict; }

  private:
    [[nodiscard]] Disagreement run(bool any_hit, bool swapped) const {
        const auto sound = make_intersector(AccelKind::naive, geometry.view());
        const Defective broken(*sound, defect);
        ValidationOptions keep;
        keep.keep_explained = 1;
        const Intersector& first = swapped ? static_cast<const Intersector&>(broken) : *sound;
        const Intersector& second = swapped ? *sound : static_cast<const Intersector&>(broken);
        const ValidatingIntersector both(geometry.view(), first, second, keep);
        if (any_hit)
            (void)both.occluded(ray);
        else
            (void)both.closest(ray);
        const ValidationReport report = both.report();
        if (!report.unexplained.empty())
            return report.unexplained[0];
        if (!report.explained.empty())
            return report.explained[0];
        Disagreement none; // equal, or some ulps, which are not kept
        none.verdict.agreement =
            report.count(Agreement::ulps) > 0 ? Agreement::ulps : Agreement::equal;
        return none;
    }
};

} // namespace plumb::test
