#include "accel/validate/replay.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

namespace plumb {
namespace {

constexpr std::size_t whole_limit = 10000;

using Ids = std::pair<std::uint32_t, std::uint32_t>;

ReplayPrimitive primitive_of(const GeometryView& view, Ids ids) {
    ReplayPrimitive p;
    p.geometry = ids.first;
    p.primitive = ids.second;
    p.is_sphere = view.is_sphere(ids.first);
    if (p.is_sphere)
        p.sphere = view.spheres[ids.second];
    else
        p.triangle = view.vertices(ids.first, ids.second);
    return p;
}

std::size_t count_of(const GeometryView& view, std::uint32_t geometry) {
    return view.is_sphere(geometry) ? view.spheres.size() : view.meshes[geometry].triangles.size();
}

template <class Visit> void for_each_primitive(const GeometryView& view, const Visit& visit) {
    for (std::uint32_t g = 0; g <= view.sphere_geometry(); ++g)
        for (std::uint32_t i = 0; i < count_of(view, g); ++i)
            visit(Ids{g, i});
}

/// Places of corners in an order, for a set.
struct ByPlace {
    bool operator()(const Vec3& a, const Vec3& b) const {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    }
};

/// What the rays hit and the triangles that share a corner with it.
std::set<Ids> concerned(const GeometryView& view, const std::vector<Disagreement>& rays) {
    std::set<Ids> ids;
    std::set<Vec3, ByPlace> corners;
    for (const Disagreement& d : rays)
        for (const Hit& hit : {d.answers.first, d.answers.second}) {
            if (!hit.valid() || hit.geometry > view.sphere_geometry() ||
                hit.primitive >= count_of(view, hit.geometry))
                continue;
            ids.emplace(hit.geometry, hit.primitive);
            if (view.is_sphere(hit.geometry) || !is_traceable(view, hit.geometry, hit.primitive))
                continue;
            const TriangleVertices t = view.vertices(hit.geometry, hit.primitive);
            corners.insert({t.a, t.b, t.c});
        }
    for_each_primitive(view, [&](Ids i) {
        if (view.is_sphere(i.first))
            return;
        const TriangleVertices t = view.vertices(i.first, i.second);
        if (corners.contains(t.a) || corners.contains(t.b) || corners.contains(t.c))
            ids.insert(i);
    });
    return ids;
}

class Writer {
  public:
    void word(std::string_view text) {
        if (!out_.empty() && out_.back() != '\n')
            out_ += ' ';
        out_ += text;
    }
    void number(std::uint32_t value) { word(std::to_string(value)); }
    void number(float value) {
        std::array<char, 32> buffer{};
        const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                       std::chars_format::hex);
        word(std::isnan(value) ? "nan" : std::string_view(buffer.data(), end.ptr));
    }
    void point(const Vec3& p) {
        for (const float c : {p.x, p.y, p.z})
            number(c);
    }
    void end_line() { out_ += '\n'; }
    template <class... Words> void line(Words... words) {
        (word(words), ...);
        end_line();
    }
    [[nodiscard]] std::string take() { return std::move(out_); }

  private:
    std::string out_;
};

void write_primitive(Writer& out, const ReplayPrimitive& p) {
    out.word(p.is_sphere ? "sphere" : "triangle");
    out.number(p.geometry);
    out.number(p.primitive);
    if (p.is_sphere) {
        out.point(p.sphere.center);
        out.number(p.sphere.radius);
    } else {
        for (const Vec3& corner : {p.triangle.a, p.triangle.b, p.triangle.c})
            out.point(corner);
    }
    out.end_line();
}

void write_answer(Writer& out, std::string_view side, const Hit& hit, const Answers& answers,
                  bool found) {
    out.word(side);
    if (answers.any_hit)
        out.word(found ? "blocked" : "free");
    out.word(hit.valid() ? "hit" : "miss");
    if (hit.valid()) {
        out.number(hit.geometry);
        out.number(hit.primitive);
        for (const float x : {hit.t, hit.u, hit.v})
            out.number(x);
    }
    out.end_line();
}

void write_ray(Writer& out, const Disagreement& d) {
    out.word("ray");
    out.word(name_of(d.kind));
    out.word(name_of(d.verdict.agreement));
    out.word(name_of(d.verdict.culprit));
    out.point(d.ray.origin);
    out.number(d.ray.tmin);
    out.point(d.ray.direction);
    out.number(d.ray.tmax);
    out.end_line();
    write_answer(out, "first", d.answers.first, d.answers, d.answers.first_found);
    write_answer(out, "second", d.answers.second, d.answers, d.answers.second_found);
}

} // namespace

Replay make_replay(const GeometryView& geometry, std::vector<Disagreement> rays) {
    Replay replay;
    replay.whole_geometry = geometry.primitive_count() <= whole_limit;
    if (replay.whole_geometry) {
        for_each_primitive(
            geometry, [&](Ids ids) { replay.primitives.push_back(primitive_of(geometry, ids)); });
    } else {
        for (const Ids& ids : concerned(geometry, rays))
            replay.primitives.push_back(primitive_of(geometry, ids));
    }
    replay.rays = std::move(rays);
    return replay;
}

std::string to_text(const Replay& replay) {
    Writer out;
    out.line("plumbline-replay", "1");
    if (!replay.scene.empty())
        out.line("scene", replay.scene);
    out.line("test",
             replay.triangle_test == TriangleTest::watertight ? "watertight" : "moeller-trumbore");
    out.line("pair", name_of(replay.first), name_of(replay.second));
    out.line("geometry", replay.whole_geometry ? "whole" : "concerned");
    for (const ReplayPrimitive& p : replay.primitives)
        write_primitive(out, p);
    for (const Disagreement& d : replay.rays)
        write_ray(out, d);
    out.line("end");
    return out.take();
}

} // namespace plumb
