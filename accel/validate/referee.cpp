#include "accel/validate/referee.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace plumb {
namespace {

constexpr double u = 0x1p-24;         // unit_roundoff
constexpr double smallest = 0x1p-149; // float's step below 2^-126, where errors are not relative
constexpr double unlimited = std::numeric_limits<double>::infinity();

struct Double3 {
    double x, y, z;
};
Double3 widen(Vec3 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
Double3 operator-(Double3 a, Double3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Double3 operator*(double s, Double3 a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(Double3 a, Double3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Double3 cross(Double3 a, Double3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double length(Double3 a) { return std::sqrt(dot(a, a)); }

/// A place in the plane across the ray, the ray being (0, 0).
struct Place {
    double x, y;
};
double cross(Place p, Place q) { return p.x * q.y - p.y * q.x; }
Place operator-(Place p, Place q) { return {p.x - q.x, p.y - q.y}; }
double length(Place p) { return std::hypot(p.x, p.y); }

/// The plane across a ray and the depth along it.
struct View {
    Double3 origin, along, right, up; // unit vectors
    double speed;

    explicit View(const Ray& ray) : origin(widen(ray.origin)) {
        const Double3 d = widen(ray.direction);
        speed = length(d);
        along = 1 / speed * d;
        const Double3 helper = std::fabs(along.x) < 0.6   ? Double3{1, 0, 0}
                               : std::fabs(along.y) < 0.6 ? Double3{0, 1, 0}
                                                          : Double3{0, 0, 1};
        right = cross(along, helper);
        right = 1 / length(right) * right;
        up = cross(along, right);
    }
    [[nodiscard]] Place place(Double3 offset) const {
        return {dot(offset, right), dot(offset, up)};
    }
    [[nodiscard]] double t(Double3 offset) const { return dot(offset, along) / speed; }
};

struct SeenTriangle {
    std::array<Double3, 3> offset; ///< corners from the origin
    std::array<Place, 3> place;
    std::array<double, 3> t;
    double reach; ///< to the farthest corner

    SeenTriangle(const View& view, const TriangleVertices& vertices)
        : offset{widen(vertices.a) - view.origin, widen(vertices.b) - view.origin,
                 widen(vertices.c) - view.origin} {
        for (std::size_t i = 0; i < 3; ++i) {
            place[i] = view.place(offset[i]);
            t[i] = view.t(offset[i]);
        }
        reach = std::max({length(offset[0]), length(offset[1]), length(offset[2])});
    }
};

Answer range_of(const Crossing& c, const Ray& ray) {
    const double low = c.t - c.t_error, high = c.t + c.t_error;
    const auto tmin = static_cast<double>(ray.tmin), tmax = static_cast<double>(ray.tmax);
    if (std::isnan(low) || std::isnan(high))
        return Answer::either;
    if (high <= tmin || low > tmax)
        return Answer::no;
    const double largest = static_cast<double>(std::numeric_limits<float>::max());
    return low > tmin && high <= std::min(tmax, largest) ? Answer::yes : Answer::either;
}

Answer both(Answer a, Answer b) {
    if (a == Answer::no || b == Answer::no)
        return Answer::no;
    return a == Answer::yes && b == Answer::yes ? Answer::yes : Answer::either;
}

Judgement judge_triangle(const TriangleVertices& vertices, const Ray& ray) {
    const View view(ray);
    const SeenTriangle tri(view, vertices);
    const auto& p = tri.place;
    std::array<double, 3> weight{}, error{}; // edge functions opposite to each corner
    bool positive = false, negative = false, plain = true;
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        weight[i] = cross(p[j], p[k]);
        const double edge = length(tri.offset[k] - tri.offset[j]);
        longest = std::max(longest, edge);
        const double a = length(p[j]), b = length(p[k]);
        error[i] = u * (8 * tri.reach * (a + b) + 2 * a * b + 8 * edge * tri.reach);
        positive = positive || weight[i] > error[i];
        negative = negative || weight[i] < -error[i];
        plain = plain && std::fabs(weight[i]) > error[i];
    }
    const double area = weight[0] + weight[1] + weight[2];
    const bool in_float_range = tri.reach * tri.reach * std::max(1.0, view.speed) < 1e37 &&
                                longest * longest * std::min(1.0, view.speed) > 1e-30;
    Judgement out;
    out.inside = positive && negative      ? Answer::no
                 : plain && in_float_range ? Answer::yes
                                           : Answer::either;
    if (out.inside == Answer::no && !in_float_range)
        out.inside = Answer::either;
    out.margin = unlimited;
    double area_error = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        out.margin = std::min(out.margin, std::copysign(1.0, area) * weight[i] / error[i]);
        area_error += error[i];
    }
    const double size = std::fabs(area);
    out.u = weight[1] / area;
    out.v = weight[2] / area;
    out.uv_error = area_error / size + 4 * u;
    Crossing& c = out.near;
    c.t = (weight[0] * tri.t[0] + weight[1] * tri.t[1] + weight[2] * tri.t[2]) / area;
    const Double3 e1 = tri.offset[1] - tri.offset[0], e2 = tri.offset[2] - tri.offset[0];
    const double a = length(e1), b = length(e2);
    c.t_error =
        8 * u * (length(cross(e1, e2)) * tri.reach + a * b * std::max(a, b)) / (size * view.speed);
    c.t_error += 8 * smallest * (1 + 2 / view.speed);
    for (std::size_t i = 0; i < 3; ++i)
        c.t_error += error[i] / size * std::fabs(tri.t[i] - c.t) + 4 * u * std::fabs(tri.t[i]) / 3;
    c.in_range = range_of(c, ray);
    out.far = c;
    out.answer = both(out.inside, c.in_range);
    return out;
}

Judgement judge_sphere(const Sphere& sphere, const Ray& ray) {
    const View view(ray);
    const Double3 center = widen(sphere.center) - view.origin;
    const auto r = static_cast<double>(sphere.radius);
    const double beside = length(cross(view.along, center)), distance = length(center);
    const double outline_error = 8 * u * (distance + r);
    Judgement out;
    out.margin = (r - beside) / outline_error;
    out.inside = out.margin > 1 ? Answer::yes : out.margin < -1 ? Answer::no : Answer::either;
    const double half = std::sqrt(std::max((r - beside) * (r + beside), 0.0));
    // Half the chord follows an error of `beside` in double, by its derivative or its root.
    const double beside_error = 0x1p-50 * (distance + r);
    const double chord_error =
        std::min(half > 0 ? r * beside_error / half : unlimited, std::sqrt(2 * r * beside_error));
    const double middle = dot(view.along, center);
    for (Crossing* c : {&out.near, &out.far}) {
        c->t = (middle + (c == &out.near ? -half : half)) / view.speed;
        c->t_error = (chord_error + 8 * u * (distance + r)) / view.speed +
                     8 * smallest * (1 + 2 / view.speed);
        c->in_range = range_of(*c, ray);
    }
    // A hit is certain if a crossing is, even if rounding decides which of the two counts.
    const bool certain = out.near.in_range == Answer::yes || out.far.in_range == Answer::yes;
    const bool possible = out.near.in_range != Answer::no || out.far.in_range != Answer::no;
    out.answer = both(out.inside, certain ? Answer::yes : possible ? Answer::either : Answer::no);
    return out;
}

/// How far a reported t is from a crossing in units of its bound, which is 8 ulp or more. NaN
/// where the bound is not a number: an edge-on triangle.
double share_at(const Crossing& c, float t) {
    return std::fabs(static_cast<double>(t) - c.t) / std::max(c.t_error, 16 * u * std::fabs(c.t));
}

bool is_at(const Crossing& c, float t) { return c.in_range != Answer::no && !(share_at(c, t) > 1); }

/// Whether p lies in the triangle, either winding, outline included.
bool covers(const std::array<Place, 3>& triangle, Place p) {
    const double a = cross(triangle[0] - p, triangle[1] - p),
                 b = cross(triangle[1] - p, triangle[2] - p),
                 c = cross(triangle[2] - p, triangle[0] - p);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

} // namespace

Judgement judge(const GeometryView& view, std::uint32_t geometry, std::uint32_t primitive,
                const Ray& ray) {
    const bool sphere = view.is_sphere(geometry);
    if (geometry > view.sphere_geometry() ||
        primitive >= (sphere ? view.spheres.size() : view.meshes[geometry].triangles.size()) ||
        !is_valid(ray) || !is_traceable(view, geometry, primitive))
        return {};
    return sphere ? judge_sphere(view.spheres[primitive], ray)
                  : judge_triangle(view.vertices(geometry, primitive), ray);
}

bool is_right_t(const Judgement& judgement, float t) {
    if (std::isnan(t))
        return false;
    return is_at(judgement.near, t) ||
           (judgement.near.in_range != Answer::yes && is_at(judgement.far, t));
}

double share_of_bound(const Judgement& judgement, float t) {
    const double near = share_at(judgement.near, t), far = share_at(judgement.far, t);
    return std::isnan(near) ? 0 : std::min(near, far);
}

bool are_right_uv(const Judgement& judgement, float reported_u, float reported_v) {
    const double bound = std::max(judgement.uv_error, 16 * u);
    // Written so that a bound that is not a number (no projected area) accepts every number.
    return !std::isnan(reported_u) && !std::isnan(reported_v) &&
           !(std::fabs(static_cast<double>(reported_u) - judgement.u) > bound) &&
           !(std::fabs(static_cast<double>(reported_v) - judgement.v) > bound);
}

int shared_corners(const GeometryView& view, const Hit& a, const Hit& b) {
    if (view.is_sphere(a.geometry) || view.is_sphere(b.geometry))
        return 0;
    const TriangleVertices p = view.vertices(a.geometry, a.primitive),
                           q = view.vertices(b.geometry, b.primitive);
    int shared = 0;
    for (const Vec3& x : {p.a, p.b, p.c})
        for (const Vec3& y : {q.a, q.b, q.c})
            shared += x == y;
    return shared;
}

bool is_closed_around(const GeometryView& view, const Hit& hit, const Ray& ray) {
    const Judgement own = judge(view, hit.geometry, hit.primitive, ray);
    if (view.is_sphere(hit.geometry) || own.inside == Answer::no)
        return false;
    const View seen(ray);
    constexpr std::size_t samples = 32;
    std::array<bool, samples> covered{};
    const SeenTriangle middle(seen, view.vertices(hit.geometry, hit.primitive));
    const double radius = 64 * u * middle.reach;
    const auto cover = [&](const SeenTriangle& triangle) {
        for (std::size_t i = 0; i < samples; ++i) {
            const double angle = 0.1 + 6.283185307179586 * static_cast<double>(i) / samples;
            covered[i] = covered[i] || covers(triangle.place,
                                              {radius * std::cos(angle), radius * std::sin(angle)});
        }
    };
    cover(middle);
    for (std::uint32_t g = 0; g < view.meshes.size(); ++g)
        for (std::uint32_t i = 0; i < view.meshes[g].triangles.size(); ++i) {
            Hit other;
            other.geometry = g;
            other.primitive = i;
            if (shared_corners(view, hit, other) == 0)
                continue;
            const Judgement j = judge(view, g, i, ray);
            if (j.inside == Answer::no || j.near.in_range != Answer::yes ||
                std::fabs(j.near.t - own.near.t) > j.near.t_error + own.near.t_error)
                continue;
            cover(SeenTriangle(seen, view.vertices(g, i)));
        }
    return std::all_of(covered.begin(), covered.end(), [](bool c) { return c; });
}

Hit search(const GeometryView& view, const Ray& ray) {
    Hit possible;
    for (std::uint32_t g = 0; g <= view.sphere_geometry(); ++g) {
        const std::size_t count =
            view.is_sphere(g) ? view.spheres.size() : view.meshes[g].triangles.size();
        for (std::uint32_t i = 0; i < count; ++i) {
            const Judgement j = judge(view, g, i, ray);
            if (j.answer == Answer::no)
                continue;
            possible = {static_cast<float>(j.near.t),
                        static_cast<float>(j.u),
                        static_cast<float>(j.v),
                        g,
                        i,
                        invalid_id};
            if (j.answer == Answer::yes)
                return possible;
        }
    }
    return possible;
}

} // namespace plumb
