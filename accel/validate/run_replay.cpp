#include "accel/validate/run_replay.h"

#include "accel/validate/referee.h"

#include <algorithm>
#include <iomanip>
#include <ostream>

namespace plumb {
namespace {

struct Named {
    std::string name;
    AccelKind kind;
    std::unique_ptr<Intersector> intersector;
};

void add(std::vector<Named>& list, const std::string& name, AccelKind kind,
         const GeometryView& view, const BuildOptions& options, std::ostream& out) {
    try {
        list.push_back({name, kind, make_intersector(kind, view, options)});
    } catch (const std::runtime_error& error) { // not on this processor, or not with this test
        out << name << ": not there: " << error.what() << '\n';
    }
}

std::vector<Named> all_intersectors(const Replay& replay, const GeometryView& view,
                                    std::ostream& out) {
    std::vector<Named> list;
    BuildOptions options;
    options.triangle_test = replay.triangle_test;
    add(list, "naive", AccelKind::naive, view, options, out);
    for (const Isa isa : {Isa::automatic, Isa::portable, Isa::avx2, Isa::avx512}) {
        options.isa = isa;
        add(list, isa == Isa::automatic ? "sah" : "sah " + std::string(name_of(isa)),
            AccelKind::sah, view, options, out);
    }
    add(list, "embree", AccelKind::embree, view, {}, out); // has its own watertight test
    return list;
}

const Intersector* find(const std::vector<Named>& list, AccelKind kind) {
    for (const Named& n : list)
        if (n.kind == kind)
            return n.intersector.get();
    return nullptr;
}

std::ostream& operator<<(std::ostream& out, const Hit& hit) {
    if (!hit.valid())
        return out << "miss";
    return out << hit.geometry << ':' << hit.primitive << " t " << hit.t << " u " << hit.u << " v "
               << hit.v;
}

std::ostream& operator<<(std::ostream& out, const Vec3& v) {
    return out << '(' << v.x << ' ' << v.y << ' ' << v.z << ')';
}

void print_answer(std::ostream& out, std::string_view name, const Answers& answers, const Hit& hit,
                  bool found) {
    out << "  " << std::left << std::setw(14) << name;
    if (answers.any_hit)
        out << (found ? "blocked; " : "free; ");
    out << hit << '\n';
}

std::string_view text_of(Answer answer) {
    return answer == Answer::yes ? "hit" : answer == Answer::no ? "no hit" : "either";
}

void print_judgement(std::ostream& out, const GeometryView& view, const Hit& here, const Hit& named,
                     const Ray& ray) {
    const Judgement j = judge(view, here.geometry, here.primitive, ray);
    out << "  referee       " << named.geometry << ':' << named.primitive << ' '
        << text_of(j.answer) << ", t " << std::setprecision(17) << j.near.t << std::setprecision(3)
        << " +- " << j.near.t_error << ", " << j.margin << " bounds inside the outline\n"
        << std::setprecision(9);
}

std::string_view name_of(Culprit culprit, const Replay& replay) {
    return culprit == Culprit::first    ? name_of(replay.first)
           : culprit == Culprit::second ? name_of(replay.second)
                                        : name_of(culprit);
}

/// Both sides' answers to the ray, now.
Answers ask(const Replay& replay, const std::vector<Named>& list, const Disagreement& d) {
    Answers now;
    now.any_hit = d.answers.any_hit;
    const Intersector &first = *find(list, replay.first), &second = *find(list, replay.second);
    now.first = first.closest(d.ray);
    now.second = second.closest(d.ray);
    now.first_found = now.any_hit && first.occluded(d.ray);
    now.second_found = now.any_hit && second.occluded(d.ray);
    return now;
}

bool is_same(const Answers& a, const Answers& b) {
    return is_equal(a.first, b.first) && is_equal(a.second, b.second) &&
           a.first_found == b.first_found && a.second_found == b.second_found;
}

/// Prints what a pair of which both are there does now; counts it.
void compare_pair(const Replay& replay, const ReplayGeometry& geometry,
                  const std::vector<Named>& list, const Disagreement& d, ReplayOutcome& outcome,
                  std::ostream& out) {
    const Intersector *first = find(list, replay.first), *second = find(list, replay.second);
    if (first == nullptr || second == nullptr)
        return;
    Answers now = ask(replay, list, d);
    const Classifier classifier(geometry.view(), *first, *second);
    const Verdict verdict = now.any_hit ? classifier.occluded(d.ray, now)
                                        : classifier.closest(d.ray, now.first, now.second);
    now.first = geometry.to_scene(now.first);
    now.second = geometry.to_scene(now.second);
    const bool again = is_same(now, d.answers);
    outcome.reproduced += again ? 1u : 0u;
    outcome.unexplained += is_explained(verdict.agreement) ? 0u : 1u;
    out << "  now           " << name_of(verdict.agreement)
        << ", wrong: " << name_of(verdict.culprit, replay)
        << (again ? "; reproduced" : "; NOT reproduced")
        << (replay.whole_geometry ? " with the whole geometry\n"
                                  : " with the primitives concerned alone\n");
}

void run_ray(const Replay& replay, const ReplayGeometry& geometry, const std::vector<Named>& list,
             std::size_t index, ReplayOutcome& outcome, std::ostream& out) {
    const Disagreement& d = replay.rays[index];
    out << "ray " << index + 1 << ' ' << name_of(d.kind) << ": origin " << d.ray.origin
        << " direction " << d.ray.direction << " t " << d.ray.tmin << " to " << d.ray.tmax << '\n';
    print_answer(out, "was " + std::string(name_of(replay.first)), d.answers, d.answers.first,
                 d.answers.first_found);
    print_answer(out, "was " + std::string(name_of(replay.second)), d.answers, d.answers.second,
                 d.answers.second_found);
    out << "  was           " << name_of(d.verdict.agreement)
        << ", wrong: " << name_of(d.verdict.culprit, replay) << '\n';
    std::vector<Hit> hits{geometry.from_scene(d.answers.first),
                          geometry.from_scene(d.answers.second)};
    for (const Named& n : list) {
        hits.push_back(n.intersector->closest(d.ray));
        const bool found = d.answers.any_hit && n.intersector->occluded(d.ray);
        print_answer(out, n.name, d.answers, geometry.to_scene(hits.back()), found);
    }
    const auto ids = [](const Hit& hit) { return std::pair(hit.geometry, hit.primitive); };
    std::sort(hits.begin(), hits.end(),
              [&](const Hit& a, const Hit& b) { return ids(a) < ids(b); });
    const auto last = std::unique(hits.begin(), hits.end(),
                                  [&](const Hit& a, const Hit& b) { return ids(a) == ids(b); });
    for (auto hit = hits.begin(); hit != last; ++hit)
        if (hit->valid())
            print_judgement(out, geometry.view(), *hit, geometry.to_scene(*hit), d.ray);
    compare_pair(replay, geometry, list, d, outcome, out);
}

} // namespace

ReplayGeometry::ReplayGeometry(const Replay& replay) : replay_(replay) {
    const auto& all = replay.primitives;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i == 0 || all[i].geometry != all[i - 1].geometry)
            first_.push_back(i);
        if (all[i].is_sphere) {
            spheres_.push_back(all[i].sphere);
            continue;
        }
        const auto corner = static_cast<std::uint32_t>(positions_.size());
        const TriangleVertices& t = all[i].triangle;
        positions_.insert(positions_.end(), {t.a, t.b, t.c});
        triangles_.push_back({corner, corner + 1, corner + 2});
    }
    first_.push_back(all.size());
    for (std::size_t g = 0; g + 1 < first_.size(); ++g)
        if (!all[first_[g]].is_sphere)
            meshes_.push_back(
                {positions_, std::span(triangles_).subspan(first_[g], first_[g + 1] - first_[g])});
}

Hit ReplayGeometry::to_scene(Hit hit) const {
    if (hit.geometry + std::size_t{1} >= first_.size() ||
        hit.primitive >= first_[hit.geometry + 1] - first_[hit.geometry])
        return {};
    const ReplayPrimitive& p = replay_.primitives[first_[hit.geometry] + hit.primitive];
    hit.geometry = p.geometry;
    hit.primitive = p.primitive;
    return hit;
}

Hit ReplayGeometry::from_scene(Hit hit) const {
    const auto& all = replay_.primitives;
    const auto found = std::find_if(all.begin(), all.end(), [&](const ReplayPrimitive& p) {
        return p.geometry == hit.geometry && p.primitive == hit.primitive;
    });
    if (found == all.end())
        return {};
    const auto index = static_cast<std::size_t>(found - all.begin());
    const auto next = std::upper_bound(first_.begin(), first_.end() - 1, index);
    hit.geometry = static_cast<std::uint32_t>(next - first_.begin() - 1);
    hit.primitive = static_cast<std::uint32_t>(index - first_[hit.geometry]);
    return hit;
}

ReplayOutcome run_replay(const Replay& replay, std::ostream& out) {
    const auto flags = out.flags();
    const auto precision = out.precision(9);
    const ReplayGeometry geometry(replay);
    out << replay.rays.size() << " rays, " << replay.primitives.size() << " primitives ("
        << (replay.whole_geometry ? "the whole geometry" : "those concerned") << ")"
        << (replay.scene.empty() ? "" : " of " + replay.scene) << '\n';
    const std::vector<Named> list = all_intersectors(replay, geometry.view(), out);
    ReplayOutcome outcome;
    outcome.rays = replay.rays.size();
    for (std::size_t i = 0; i < replay.rays.size(); ++i)
        run_ray(replay, geometry, list, i, outcome, out);
    out << outcome.reproduced << " of " << outcome.rays << " reproduced, " << outcome.unexplained
        << " unexplained\n";
    out.flags(flags);
    out.precision(precision);
    return outcome;
}

} // namespace plumb
