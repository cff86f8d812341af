/// \file  The path tracer: one kernel for every intersector, host and device.
///
/// J. Kajiya, "The Rendering Equation", SIGGRAPH 1986; light and BSDF samples are combined by the
/// power heuristic of E. Veach, L. Guibas, "Optimally Combining Sampling Techniques", SIGGRAPH
/// 1995.
#pragma once

#include "renderer/sampling/distribution.h"
#include "renderer/sampling/light_sampling.h"
#include "renderer/sampling/sampler.h"
#include "renderer/scene/features.h"
#include "renderer/shading/bsdf.h"
#include "renderer/shading/interaction.h"

#include <cstdint>

namespace plumb {

/// Rays traced, by kind.
struct RayCounts {
    std::uint64_t camera = 0, bounce = 0, shadow = 0;

    [[nodiscard]] RT_HD std::uint64_t total() const { return camera + bounce + shadow; }
    RT_HD RayCounts& operator+=(const RayCounts& o) {
        camera += o.camera;
        bounce += o.bounce;
        shadow += o.shadow;
        return *this;
    }
};

/// Weight of a sample with pdf `mine` beside another strategy with pdf `other` (Veach 1997, 9.2.3).
RT_HD inline float power_heuristic(float mine, float other) {
    const float ratio = other / mine;
    return 1 / (1 + ratio * ratio);
}

/// Dimension groups of the sampler: 0 places the sample on the film; bounce k (from 1) draws its
/// light point and its direction from group 2k - 1, the light and roulette from group 2k.
RT_HD constexpr std::uint32_t direction_group(int depth) {
    return 2 * static_cast<std::uint32_t>(depth) - 1;
}
RT_HD constexpr std::uint32_t choice_group(int depth) {
    return 2 * static_cast<std::uint32_t>(depth);
}

/// Traces paths through one scene. `F`: what the kernel can do, must cover the scene. `Query` has
/// `Hit closest(const Ray&) const` and `bool occluded(const Ray&) const`.
template <Features F, class Query> class PathTracer {
  public:
    RT_HD PathTracer(const SceneView& scene, const Query& query, const PathSettings& settings)
        : scene_(scene), query_(query), settings_(settings) {}

    /// Radiance arriving along a camera ray, one sample. Finite for finite scenes.
    [[nodiscard]] RT_HD Rgb trace(Ray ray, const Sampler& sampler, RayCounts& counts) const {
        Path path{ray, normalize(-ray.direction), {}, {1, 1, 1}, 0, {}};
        for (int depth = 1;; ++depth) {
            ++(depth == 1 ? counts.camera : counts.bounce);
            const Hit hit = query_.closest(path.ray);
            if (!hit.valid()) {
                add_environment(path, depth);
                break;
            }
            const Vertex vertex = vertex_at(hit, path);
            add_emission(path, vertex, depth);
            if (depth == settings_.max_depth || vertex.material == invalid_id)
                break;
            const Sample4 u = sampler.group(direction_group(depth));
            Sample4 choice{};
            if (F.many_lights || roulette_plays(depth))
                choice = sampler.group(choice_group(depth));
            add_direct_light(path, vertex, {u.x[0], u.x[1]}, choice.x[0], counts);
            if (!scatter(path, vertex, {u.x[2], u.x[3]}) || !survives(path, depth, choice.x[1]))
                break;
        }
        return path.radiance;
    }

  private:
    struct Path {
        Ray ray;
        Vec3 wo; ///< unit, back along the ray
        Rgb radiance;
        Rgb throughput;
        float pdf;     ///< of the last direction, per solid angle
        Receiver from; ///< where the ray started, after the first bounce
    };

    struct Vertex {
        Interaction at;
        Vec3 geometric; ///< unit normals on the side of wo
        Vec3 shading;
        bool front;
        std::uint32_t surface, primitive, material;
    };

    RT_HD Vertex vertex_at(const Hit& hit, const Path& path) const {
        Vertex v;
        v.at = interact<F.spheres, F.smooth_normals>(scene_, hit, path.ray);
        v.front = dot(path.wo, v.at.geometric) > 0;
        v.geometric = v.front ? v.at.geometric : -v.at.geometric;
        v.shading = v.front ? v.at.shading : -v.at.shading;
        if constexpr (F.smooth_normals)
            if (!(dot(path.wo, v.shading) > 0)) // interpolated away from the viewer
                v.shading = v.geometric;
        v.surface = F.spheres ? scene_.surface_of(hit) : hit.geometry;
        v.primitive = hit.primitive;
        const Surface& surface = scene_.surfaces[v.surface];
        v.material = v.front ? surface.front : surface.back;
        return v;
    }

    /// Share of a light that a ray found by its BSDF may count.
    RT_HD float found_weight(const Path& path, int depth, std::uint32_t light, Vec3 point) const {
        if (depth == 1)
            return settings_.hide_emitters ? 0 : 1;
        if (settings_.estimator != Estimator::mis)
            return settings_.estimator == Estimator::bsdf ? 1 : 0;
        const Light& l = scene_.lights[light];
        const float pdf =
            l.probability * light_pdf<F>(l, path.from, -path.wo, point, settings_.light_sampling);
        return power_heuristic(path.pdf, pdf);
    }

    RT_HD void add_environment(Path& path, int depth) const {
        if constexpr (F.environment)
            if (scene_.environment != invalid_id)
                path.radiance += path.throughput * scene_.lights[scene_.environment].emission *
                                 found_weight(path, depth, scene_.environment, {});
    }

    RT_HD void add_emission(Path& path, const Vertex& v, int depth) const {
        const SurfaceLights lights = scene_.surface_lights[v.surface];
        if (lights.first == invalid_id || !v.front)
            return;
        const std::uint32_t light = lights.first + (lights.per_primitive ? v.primitive : 0);
        path.radiance += path.throughput * scene_.surfaces[v.surface].emission *
                         found_weight(path, depth, light, v.at.position);
    }

    /// Next-event estimation: one light, one point on it.
    RT_HD void add_direct_light(Path& path, const Vertex& v, Vec2 u, float u_light,
                                RayCounts& counts) const {
        if (scene_.lights.empty() || (settings_.estimator == Estimator::bsdf && !F.point_lights))
            return;
        std::uint32_t index = 0;
        if constexpr (F.many_lights)
            index = sample_discrete(scene_.light_cdf, u_light).index;
        const Light& light = scene_.lights[index];
        const LightSample s =
            sample_light<F>(light, {v.at.position, v.geometric}, u, settings_.light_sampling);
        if (!(s.pdf > 0) || !(dot(s.wi, v.geometric) > 0) ||
            (settings_.estimator == Estimator::bsdf && !s.delta))
            return;
        const Frame frame(v.shading);
        const Vec3 wi = frame.to_local(s.wi), wo = frame.to_local(path.wo);
        const Material& material = scene_.materials[v.material];
        const Rgb reflected = bsdf_times_cos(material, wo, wi);
        if (is_black(reflected))
            return;
        ++counts.shadow;
        const Vec3 origin = offset_origin(v.at.position, v.at.error, v.at.geometric, s.wi);
        const Ray shadow = s.infinite ? Ray{origin, 0, s.wi, infinity}
                                      : Ray{origin, 0, s.target - origin, shadow_end};
        if (query_.occluded(shadow))
            return;
        const float pdf = s.pdf * light.probability;
        float weight = 1;
        if (settings_.estimator == Estimator::mis && !s.delta)
            weight = power_heuristic(pdf, bsdf_pdf(material, wo, wi, settings_.hemisphere));
        path.radiance += path.throughput * reflected * s.radiance * (weight / pdf);
    }

    /// Continues the path in a direction drawn from the BSDF; false if it ends here.
    RT_HD bool scatter(Path& path, const Vertex& v, Vec2 u) const {
        const Frame frame(v.shading);
        const BsdfSample s = sample_bsdf(scene_.materials[v.material], frame.to_local(path.wo), u,
                                         settings_.hemisphere);
        const Vec3 wi = frame.to_world(s.wi);
        if (!(s.pdf > 0) || !(dot(wi, v.geometric) > 0))
            return false;
        path.throughput *= s.weight;
        path.pdf = s.pdf;
        path.from = {v.at.position, v.geometric};
        path.ray = {offset_origin(v.at.position, v.at.error, v.at.geometric, wi), 0, wi, infinity};
        path.wo = -wi;
        return max_component(path.throughput) > 0;
    }

    RT_HD bool roulette_plays(int depth) const {
        return settings_.roulette != RouletteKind::none && depth >= settings_.rr_depth;
    }

    /// Russian roulette: goes on with probability q and divides by q.
    RT_HD bool survives(Path& path, int depth, float u) const {
        if (!roulette_plays(depth))
            return true;
        const float q = settings_.roulette == RouletteKind::constant
                            ? settings_.roulette_constant
                            : min(0.95f, max_component(path.throughput));
        if (!(u < q))
            return false;
        path.throughput *= 1 / q;
        return true;
    }

    /// Shadow rays run from 0 to 1; the light itself, at 1, does not shadow.
    static constexpr float shadow_end = 1 - 16 * unit_roundoff;

    const SceneView& scene_;
    const Query& query_;
    const PathSettings& settings_;
};

} // namespace plumb
