#include "accel/validate/classify.h"

#include "accel/validate/referee.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace plumb {
namespace {

/// The referee's opinion of a hit that an intersector reports.
enum class Claim : std::uint8_t { right, inexact, false_hit };

Claim check(const GeometryView& view, const Judgement& j, const Hit& hit) {
    if (j.answer == Answer::no)
        return Claim::false_hit;
    const bool uv = view.is_sphere(hit.geometry) || are_right_uv(j, hit.u, hit.v);
    return is_right_t(j, hit.t) && uv ? Claim::right : Claim::inexact;
}

Claim check(const GeometryView& view, const Ray& ray, const Hit& hit) {
    return check(view, judge(view, hit.geometry, hit.primitive, ray), hit);
}

Culprit opponent_of(Culprit one) {
    return one == Culprit::first ? Culprit::second : Culprit::first;
}

/// The verdict on two claims of which at least one is not right.
Verdict wrong(Claim first, Claim second) {
    const Claim worse = std::max(first, second);
    const Agreement what = worse == Claim::false_hit ? Agreement::false_hit : Agreement::inexact;
    if (first == second)
        return {what, Culprit::both};
    return {what, first > second ? Culprit::first : Culprit::second};
}

bool names_same(const Hit& a, const Hit& b) {
    return a.geometry == b.geometry && a.primitive == b.primitive && a.instance == b.instance;
}

} // namespace

std::string_view name_of(Agreement agreement) {
    switch (agreement) {
    case Agreement::equal: return "equal";
    case Agreement::ulps: return "ulps";
    case Agreement::tie: return "tie";
    case Agreement::shared_edge: return "shared_edge";
    case Agreement::range: return "range";
    case Agreement::boundary: return "boundary";
    case Agreement::inexact: return "inexact";
    case Agreement::miss: return "miss";
    case Agreement::false_hit: return "false_hit";
    case Agreement::leak: return "leak";
    }
    return "unknown";
}

std::string_view name_of(Culprit culprit) {
    switch (culprit) {
    case Culprit::none: return "none";
    case Culprit::first: return "first";
    case Culprit::second: return "second";
    case Culprit::both: return "both";
    }
    return "unknown";
}

bool is_equal(const Hit& a, const Hit& b) {
    const auto same = [](float x, float y) {
        return x == y || std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
    };
    if (!a.valid() && !b.valid())
        return true;
    return names_same(a, b) && same(a.t, b.t) && same(a.u, b.u) && same(a.v, b.v);
}

std::uint64_t ulps_between(float a, float b) {
    if (std::isnan(a) || std::isnan(b))
        return ~std::uint64_t{0};
    const auto place = [](float x) { // on the line of all floats
        const auto magnitude =
            static_cast<std::int64_t>(std::bit_cast<std::uint32_t>(x) & 0x7fffffffu);
        return std::signbit(x) ? -magnitude : magnitude;
    };
    return static_cast<std::uint64_t>(std::abs(place(a) - place(b)));
}

Classifier::Classifier(GeometryView geometry, const Intersector& first, const Intersector& second,
                       std::uint64_t scan_budget)
    : geometry_(geometry), first_(first), second_(second), scan_budget_(scan_budget) {}

Verdict Classifier::closest(const Ray& ray, const Hit& first, const Hit& second) const {
    if (is_equal(first, second))
        return {};
    if (names_same(first, second) && first.valid())
        return same_primitive(ray, first, second);
    const Claim a = first.valid() ? check(geometry_, ray, first) : Claim::right;
    const Claim b = second.valid() ? check(geometry_, ray, second) : Claim::right;
    if (a != Claim::right || b != Claim::right)
        return wrong(a, b);
    if (!second.valid())
        return not_found(ray, first, first_, infinity, Culprit::second);
    if (!first.valid())
        return not_found(ray, second, second_, infinity, Culprit::first);
    const Judgement p = judge(geometry_, first.geometry, first.primitive, ray);
    const Judgement q = judge(geometry_, second.geometry, second.primitive, ray);
    const double apart = std::fabs(static_cast<double>(first.t) - static_cast<double>(second.t));
    if (ulps_between(first.t, second.t) <= 8 || !(apart > p.near.t_error + q.near.t_error)) {
        const bool beside = p.inside == Answer::either || q.inside == Answer::either;
        return {beside && shared_corners(geometry_, first, second) > 0 ? Agreement::shared_edge
                                                                       : Agreement::tie,
                Culprit::none};
    }
    return first.t < second.t ? not_found(ray, first, first_, second.t, Culprit::second)
                              : not_found(ray, second, second_, first.t, Culprit::first);
}

Verdict Classifier::same_primitive(const Ray& ray, const Hit& first, const Hit& second) const {
    // Most rays that differ do so by a few ulp: these need no referee.
    const auto near = [](float x, float y) { return std::fabs(x - y) <= 8 * 2 * unit_roundoff; };
    if (ulps_between(first.t, second.t) <= 8 && near(first.u, second.u) && near(first.v, second.v))
        return {Agreement::ulps, Culprit::none};
    const Judgement j = judge(geometry_, first.geometry, first.primitive, ray);
    const Claim a = check(geometry_, j, first), b = check(geometry_, j, second);
    if (a != Claim::right || b != Claim::right)
        return wrong(a, b);
    // Two crossings of one sphere are both right only where the range decides.
    const double apart = std::fabs(static_cast<double>(first.t) - static_cast<double>(second.t));
    if (j.near.in_range == Answer::either && apart > 2 * j.near.t_error)
        return {Agreement::range, Culprit::none};
    const double share = std::max(share_of_bound(j, first.t), share_of_bound(j, second.t));
    return {Agreement::ulps, Culprit::none, share};
}

/// `finder` reports `hit`, which is right; the loser has nothing nearer than `limit`. It is wrong
/// if this hit is certain, or another that the finder meets between the two.
Verdict Classifier::not_found(const Ray& ray, const Hit& hit, const Intersector& finder,
                              float limit, Culprit loser) const {
    const Judgement own = judge(geometry_, hit.geometry, hit.primitive, ray);
    if (own.answer == Answer::yes)
        return {Agreement::miss, loser};
    constexpr int layers = 16; // rays that graze more outlines in a row are not known
    Ray rest = ray;
    Hit next = hit;
    for (int i = 0; i < layers && next.valid() && next.t < limit; ++i) {
        const Judgement j = judge(geometry_, next.geometry, next.primitive, ray);
        const bool before = j.near.t + j.near.t_error < static_cast<double>(limit);
        if (j.answer == Answer::yes && before)
            return {Agreement::miss, loser};
        if (!(next.t > rest.tmin))
            break;
        rest.tmin = next.t;
        next = finder.closest(rest);
    }
    // A float test may lose this hit at an end of the range, whatever is around the ray.
    if (own.inside == Answer::yes || own.near.in_range == Answer::either)
        return {Agreement::range, Culprit::none};
    if (may_scan() && is_closed_around(geometry_, hit, ray))
        return {Agreement::leak, loser};
    return {Agreement::boundary, Culprit::none};
}

bool Classifier::may_scan() const {
    const std::uint64_t cost = geometry_.primitive_count();
    if (scanned_.fetch_add(cost) + cost <= scan_budget_)
        return true;
    ++unchecked_;
    return false;
}

Verdict Classifier::occluded(const Ray& ray, Answers& answers) const {
    if (answers.first_found == answers.second_found)
        return {};
    answers.first = first_.closest(ray);
    answers.second = second_.closest(ray);
    const Culprit finder = answers.first_found ? Culprit::first : Culprit::second;
    const bool own = (finder == Culprit::first ? answers.first : answers.second).valid();
    // Where the finder's closest() finds nothing, what the other's finds tells the primitive.
    const bool use_first = own == (finder == Culprit::first);
    Hit& hit = use_first ? answers.first : answers.second;
    if (!hit.valid() && may_scan())
        hit = search(geometry_, ray);
    if (!hit.valid())
        return {Agreement::false_hit, finder};
    if (check(geometry_, ray, hit) == Claim::false_hit)
        return {Agreement::false_hit, finder};
    return not_found(ray, hit, use_first ? first_ : second_, infinity, opponent_of(finder));
}

} // namespace plumb
