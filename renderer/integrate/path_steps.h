/// \file  The steps of a path from vertex to vertex, host and device.
///
/// What happens at a vertex, apart from the ray queries: `path.h` strings the steps together for
/// one path, `path_stream.h` for many. Steps that are functions of values alone and have no branch
/// to speak of (finish_direct, scatter_from) are loops over lanes there.
#pragma once

#include "renderer/sampling/distribution.h"
#include "renderer/sampling/light_sampling.h"
#include "renderer/sampling/sampler.h"
#include "renderer/scene/features.h"
#include "renderer/shading/bsdf.h"
#include "renderer/shading/interaction.h"

#include <cstdint>

namespace plumb {

/// A path on its way to the next vertex.
struct Path {
    Ray ray;
    Vec3 wo; ///< unit, back along the ray
    Rgb throughput;
    float pdf;     ///< of the ray's direction, per solid angle; of use after the first bounce
    Receiver from; ///< where the ray started, likewise
};

/// Where a path meets a surface.
struct Vertex {
    Vec3 position;
    Vec3 error;     ///< bound of |position - true point|, each axis
    Vec3 geometric; ///< unit normals on the side of wo
    Vec3 shading;
    bool front; ///< whether that is the front of the surface
    std::uint32_t surface, primitive, material;
};

/// Light that one sample of the lights sends to a vertex and on to the camera.
struct DirectLight {
    bool counts = false; ///< if the shadow ray is free
    Ray shadow;
    Rgb radiance;
};

/// A new direction at a vertex.
struct Scattered {
    bool lives; ///< whether the path goes on
    Vec3 origin;
    Vec3 direction; ///< unit
    Rgb throughput;
    float pdf;
};

/// Weight of a sample with pdf `mine` beside another strategy with pdf `other` (Veach 1997, 9.2.3).
RT_HD inline float power_heuristic(float mine, float other) {
    const float ratio = other / mine;
    return 1 / (1 + ratio * ratio);
}

/// Dimension groups of the sampler: 0 places the sample on the film. Bounce k (from 1) draws its
/// light point, the light and roulette from group 2k; the directions of bounces k and k + 1, k odd,
/// are one point of group k, so that they are stratified together, which leaves less error in what
/// comes from the second bounce on than directions that know nothing of each other.
RT_HD constexpr std::uint32_t light_group(int depth) {
    return 2 * static_cast<std::uint32_t>(depth);
}
RT_HD constexpr std::uint32_t direction_group(int depth) {
    return static_cast<std::uint32_t>(depth - 1) | 1u;
}
/// Which number of its group is a direction's first.
RT_HD constexpr std::uint32_t first_of_direction(int depth) {
    return 2 * (static_cast<std::uint32_t>(depth - 1) & 1u);
}

/// The random numbers of a bounce.
struct BounceNumbers {
    Vec2 light_point;
    float light = 0, roulette = 0;
    Vec2 direction;
};

/// Shadow rays run from 0 to 1; the light itself, at 1, does not shadow.
inline constexpr float shadow_end = 1 - 16 * unit_roundoff;

/// What of a point an interaction is for a viewer in direction `wo`: its normals turned there.
template <Features F> RT_HD inline Vertex seen_from(const Interaction& at, Vec3 wo) {
    Vertex v;
    v.position = at.position;
    v.error = at.error;
    v.front = dot(wo, at.geometric) > 0;
    v.geometric = v.front ? at.geometric : -at.geometric;
    v.shading = v.geometric;
    if constexpr (F.smooth_normals) {
        v.shading = v.front ? at.shading : -at.shading;
        if (!(dot(wo, v.shading) > 0)) // interpolated away from the viewer
            v.shading = v.geometric;
    }
    return v;
}

/// Next-event estimation with a sample of a light that is chosen with probability `choice`.
RT_HD inline DirectLight finish_direct(const LightSample& s, float choice, const Vertex& v, Vec3 wo,
                                       Rgb throughput, const Material& material,
                                       const PathSettings& settings) {
    const Frame frame(v.shading);
    const Vec3 wi_local = frame.to_local(s.wi), wo_local = frame.to_local(wo);
    const Rgb reflected = bsdf_times_cos(material, wo_local, wi_local);
    const float pdf = s.pdf * choice;
    float weight = 1;
    if (settings.estimator == Estimator::mis && !s.delta)
        weight = power_heuristic(pdf, bsdf_pdf(material, wo_local, wi_local, settings.hemisphere));
    const Vec3 origin = offset_origin(v.position, v.error, v.geometric, s.wi);
    DirectLight direct;
    direct.counts = (s.pdf > 0) & (dot(s.wi, v.geometric) > 0) & (max_component(reflected) > 0) &
                    ((settings.estimator != Estimator::bsdf) | s.delta);
    direct.shadow = {origin, 0, s.infinite ? s.wi : s.target - origin,
                     s.infinite ? infinity : shadow_end};
    direct.radiance = throughput * reflected * s.radiance * (weight / pdf);
    return direct;
}

/// A direction drawn from the BSDF for u uniform in [0,1)^2.
RT_HD inline Scattered scatter_from(const Vertex& v, Vec3 wo, Rgb throughput,
                                    const Material& material, HemisphereSampling hemisphere,
                                    Vec2 u) {
    const Frame frame(v.shading);
    const BsdfSample s = sample_bsdf(material, frame.to_local(wo), u, hemisphere);
    Scattered next;
    next.direction = frame.to_world(s.wi);
    next.origin = offset_origin(v.position, v.error, v.geometric, next.direction);
    next.throughput = throughput * s.weight;
    next.pdf = s.pdf;
    next.lives =
        (s.pdf > 0) & (dot(next.direction, v.geometric) > 0) & (max_component(next.throughput) > 0);
    return next;
}

/// The steps in one scene. `F`: what they can do, must cover the scene.
template <Features F> class PathSteps {
  public:
    RT_HD PathSteps(const SceneView& scene, const PathSettings& settings)
        : scene_(scene), settings_(settings) {}

    [[nodiscard]] RT_HD static Path start(const Ray& ray) {
        return {ray, normalize(-ray.direction), {1, 1, 1}, 0, {}};
    }

    [[nodiscard]] RT_HD Vertex vertex_at(const Hit& hit, const Path& path) const {
        Vertex v =
            seen_from<F>(interact<F.spheres, F.smooth_normals>(scene_, hit, path.ray), path.wo);
        v.surface = F.spheres ? scene_.surface_of(hit) : hit.geometry;
        v.primitive = hit.primitive;
        v.material = material_of(v.surface, v.front);
        return v;
    }

    /// What covers that side of a surface; invalid_id absorbs all light.
    [[nodiscard]] RT_HD std::uint32_t material_of(std::uint32_t surface, bool front) const {
        const Surface& s = scene_.surfaces[surface];
        return front ? s.front : s.back;
    }

    /// Radiance that a path which meets nothing brings.
    [[nodiscard]] RT_HD Rgb environment(const Path& path, int depth) const {
        if constexpr (F.environment)
            if (scene_.environment != invalid_id)
                return path.throughput * scene_.lights[scene_.environment].emission *
                       found_weight(path, depth, scene_.environment, {});
        return {};
    }

    /// Radiance that the vertex itself emits along the path.
    [[nodiscard]] RT_HD Rgb emission(const Path& path, const Vertex& v, int depth) const {
        const SurfaceLights lights = scene_.surface_lights[v.surface];
        if (lights.first == invalid_id || !v.front)
            return {};
        const std::uint32_t light = lights.first + (lights.per_primitive ? v.primitive : 0);
        return path.throughput * scene_.surfaces[v.surface].emission *
               found_weight(path, depth, light, v.position);
    }

    [[nodiscard]] RT_HD bool ends_at(const Vertex& v, int depth) const {
        return depth == settings_.max_depth || v.material == invalid_id;
    }

    /// Whether the sampler's light_group is of use at this depth.
    [[nodiscard]] RT_HD bool uses_light_group(int depth) const {
        return samples_lights() || roulette_plays(depth);
    }
    [[nodiscard]] RT_HD BounceNumbers numbers(const Sampler& sampler, int depth) const {
        BounceNumbers n;
        if (uses_light_group(depth)) {
            const Sample4 u = sampler.group(light_group(depth));
            n.light_point = {u.x[0], u.x[1]};
            n.light = u.x[2];
            n.roulette = u.x[3];
        }
        const Sample4 u = sampler.group(direction_group(depth));
        const std::uint32_t first = first_of_direction(depth);
        n.direction = {u.x[first], u.x[first + 1]};
        return n;
    }
    [[nodiscard]] RT_HD bool roulette_plays(int depth) const {
        return settings_.roulette != RouletteKind::none && depth >= settings_.rr_depth;
    }
    [[nodiscard]] RT_HD bool samples_lights() const {
        return !scene_.lights.empty() && (settings_.estimator != Estimator::bsdf || F.point_lights);
    }

    /// Next-event estimation: one light, one point on it. Needs samples_lights().
    [[nodiscard]] RT_HD DirectLight direct_light(const Path& path, const Vertex& v, Vec2 u,
                                                 float u_light) const {
        std::uint32_t index = 0;
        if constexpr (F.many_lights)
            index = sample_discrete(scene_.light_cdf, u_light).index;
        const Light& light = scene_.lights[index];
        const LightSample s =
            sample_light<F>(light, {v.position, v.geometric}, u, settings_.light_sampling);
        if (!(s.pdf > 0))
            return {};
        return finish_direct(s, light.probability, v, path.wo, path.throughput,
                             scene_.materials[v.material], settings_);
    }

    /// Continues the path in a direction drawn from the BSDF; false if it ends here.
    [[nodiscard]] RT_HD bool scatter(Path& path, const Vertex& v, Vec2 u) const {
        const Scattered next = scatter_from(v, path.wo, path.throughput,
                                            scene_.materials[v.material], settings_.hemisphere, u);
        path = {{next.origin, 0, next.direction, infinity},
                -next.direction,
                next.throughput,
                next.pdf,
                {v.position, v.geometric}};
        return next.lives;
    }

    /// Russian roulette: goes on with probability q and divides by q.
    [[nodiscard]] RT_HD bool survives(Rgb& throughput, int depth, float u) const {
        if (!roulette_plays(depth))
            return true;
        const float q = settings_.roulette == RouletteKind::constant
                            ? settings_.roulette_constant
                            : min(0.95f, max_component(throughput));
        if (!(u < q))
            return false;
        throughput *= 1 / q;
        return true;
    }

    [[nodiscard]] RT_HD const SceneView& scene() const { return scene_; }
    [[nodiscard]] RT_HD const PathSettings& settings() const { return settings_; }

  private:
    /// Share of a light that a ray found by its BSDF may count.
    [[nodiscard]] RT_HD float found_weight(const Path& path, int depth, std::uint32_t light,
                                           Vec3 point) const {
        if (depth == 1)
            return settings_.hide_emitters ? 0 : 1;
        if (settings_.estimator != Estimator::mis)
            return settings_.estimator == Estimator::bsdf ? 1 : 0;
        const Light& l = scene_.lights[light];
        const float pdf =
            l.probability * light_pdf<F>(l, path.from, -path.wo, point, settings_.light_sampling);
        return power_heuristic(path.pdf, pdf);
    }

    const SceneView& scene_;
    const PathSettings& settings_;
};

} // namespace plumb
