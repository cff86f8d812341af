#include "tools/bench_src/ray_sets.h"

#include "accel/math/frame.h"
#include "renderer/sampling/warp.h"
#include "tools/bench_src/random.h"

#include <algorithm>
#include <optional>

namespace plumb::bench {
namespace {

constexpr std::size_t image_side = 1024, tile_side = 16, tile_rays = tile_side * tile_side;
constexpr std::size_t image_tiles = image_side * image_side / tile_rays;

/// Whether the i-th of many is among an evenly spread `share` of them (golden ratio, so that rows
/// of any length are cut at ever other places).
bool chosen(std::size_t i, double share) {
    const std::uint32_t place = static_cast<std::uint32_t>(i) * 2654435769u;
    return static_cast<double>(place) < share * 0x1p32;
}

/// Offset of the i-th pixel of a tile: 4 x 4 blocks of 4 x 4 pixels.
std::array<std::size_t, 2> pixel_in_tile(std::size_t i) {
    const std::size_t block = i / 16, pixel = i % 16;
    return {block % 4 * 4 + pixel % 4, block / 4 * 4 + pixel / 4};
}

std::vector<Ray> primary_rays(const BenchMesh& mesh) {
    const Viewpoint& view = mesh.view;
    const Vec3 forward = normalize(view.target - view.eye);
    const Vec3 right = normalize(cross(forward, view.up));
    const Vec3 up = cross(right, forward);
    const SinCos half = sincos_radians(view.fov_x_deg * (pi / 360));
    const float scale = half.sin / half.cos;
    const double share =
        static_cast<double>(mesh.coherent_rays) / static_cast<double>(image_side * image_side);
    std::vector<Ray> rays;
    for (std::size_t tile = 0; tile < image_tiles; ++tile)
        for (std::size_t i = 0; i < tile_rays && chosen(tile, share); ++i) {
            const auto [x, y] = pixel_in_tile(i);
            constexpr std::size_t row = image_side / tile_side;
            const auto to_screen = [](std::size_t p) {
                return (static_cast<float>(p) + 0.5f) * (2.0f / image_side) - 1;
            };
            const float sx = to_screen(tile % row * tile_side + x);
            const float sy = -to_screen(tile / row * tile_side + y);
            const Vec3 d = forward + right * (sx * scale) + up * (sy * scale);
            rays.push_back({view.eye, 0, normalize(d), infinity});
        }
    return rays;
}

/// Where a path goes on.
struct Departure {
    Vec3 origin; ///< a little off the surface
    Vec3 normal; ///< unit, on the side that the ray came from
};

std::optional<Departure> departure(const BenchMesh& mesh, const Ray& ray, const Hit& hit) {
    if (!hit.valid())
        return std::nullopt;
    const Triangle t = mesh.triangles[hit.primitive];
    const Vec3 a = mesh.positions[t.a], b = mesh.positions[t.b], c = mesh.positions[t.c];
    Vec3 normal = safe_normalize(cross(b - a, c - a));
    if (!(length(normal) > 0.5f))
        return std::nullopt;
    if (dot(normal, ray.direction) > 0)
        normal = -normal;
    const Vec3 p = a * (1 - hit.u - hit.v) + b * hit.u + c * hit.v;
    // Larger than the rounding of the point; too small to see.
    const float step = 1e-5f * (max_component(abs(p)) + hit.t * length(ray.direction));
    return Departure{p + normal * step, normal};
}

std::vector<Ray> bounce(const BenchMesh& mesh, const Intersector& guide,
                        const std::vector<Ray>& rays, Random& random) {
    std::vector<Ray> next;
    for (const Ray& ray : rays)
        if (const auto d = departure(mesh, ray, guide.closest(ray))) {
            const Vec3 local = sample_cosine_hemisphere(random.square()).direction;
            const Ray out{d->origin, 0, Frame(d->normal).to_world(local), infinity};
            if (is_valid(out))
                next.push_back(out);
        }
    return next;
}

std::vector<Ray> shadow_rays(const BenchMesh& mesh, const Intersector& guide,
                             const std::vector<Ray>& rays, Random& random) {
    std::vector<Ray> next;
    for (const Ray& ray : rays)
        if (const auto d = departure(mesh, ray, guide.closest(ray))) {
            const Vec3 on_sphere = sample_uniform_sphere(random.square()).direction;
            const Vec3 light = mesh.view.light + on_sphere * mesh.view.light_radius;
            const Ray out{d->origin, 0, light - d->origin, 1};
            if (is_valid(out))
                next.push_back(out);
        }
    return next;
}

std::vector<Ray> random_segments(const BenchMesh& mesh, Random& random) {
    const Bounds box = bounds_of(mesh);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < mesh.incoherent_rays; ++i) {
        const Vec3 from = random.point(box.lower, box.upper);
        const Ray ray{from, 0, random.point(box.lower, box.upper) - from, 1};
        if (is_valid(ray))
            rays.push_back(ray);
    }
    return rays;
}

/// About `count` rays: some of the runs of as many rays as a tile has.
std::vector<Ray> thinned(const std::vector<Ray>& rays, std::size_t count) {
    const double share =
        static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(1, rays.size()));
    std::vector<Ray> kept;
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (chosen(i / tile_rays, share))
            kept.push_back(rays[i]);
    return kept;
}

void shuffle(std::vector<Ray>& rays, Random& random) {
    for (std::size_t i = rays.size(); i > 1; --i)
        std::swap(rays[i - 1], rays[random.index(i)]);
}

} // namespace

std::string_view name_of(RayKind kind) {
    switch (kind) {
    case RayKind::primary: return "primary";
    case RayKind::shadow: return "shadow";
    case RayKind::diffuse: return "diffuse";
    case RayKind::later: return "later";
    case RayKind::random: return "random";
    }
    return "unknown";
}

std::string_view description_of(RayKind kind) {
    switch (kind) {
    case RayKind::primary: return "camera rays in blocks of 4 x 4 pixels";
    case RayKind::shadow: return "any hit from camera hits to a small light";
    case RayKind::diffuse: return "first diffuse bounce";
    case RayKind::later: return "second bounce, shuffled";
    case RayKind::random: return "segments between random points of the box";
    }
    return "unknown";
}

std::array<RaySet, ray_kinds.size()> make_ray_sets(const BenchMesh& mesh,
                                                   const Intersector& guide) {
    Random shadow(1), first(2), second(3), order(4), segments(5);
    const std::vector<Ray> primary = primary_rays(mesh);
    const std::vector<Ray> diffuse = bounce(mesh, guide, primary, first);
    std::vector<Ray> later = bounce(mesh, guide, diffuse, second);
    shuffle(later, order);
    later.resize(std::min(later.size(), mesh.incoherent_rays));
    return {RaySet{RayKind::primary, primary},
            {RayKind::shadow, shadow_rays(mesh, guide, primary, shadow)},
            {RayKind::diffuse, thinned(diffuse, mesh.incoherent_rays)},
            {RayKind::later, std::move(later)},
            {RayKind::random, random_segments(mesh, segments)}};
}

} // namespace plumb::bench
