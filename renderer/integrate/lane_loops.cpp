#include "renderer/integrate/lane_loops.h"

#include <type_traits>

namespace plumb {
namespace {

/// A whole number of the widest vectors, so that no loop has a rest.
std::size_t whole_vectors(std::size_t n) { return (n + 15) / 16 * 16; }

/// Calls loop(std::integral_constant<E, value>) with the value of a setting: the loop has one
/// branch less.
template <auto First, auto Second, class Setting, class Loop>
void with_constant(Setting value, const Loop& loop) {
    if (value == First)
        loop(std::integral_constant<Setting, First>{});
    else
        loop(std::integral_constant<Setting, Second>{});
}

/// As the loops need it: surface and material are looked up elsewhere.
Vertex vertex_of(const PathLanes& l, const Vec3Lanes& shading, std::size_t i) {
    return {l.position[i], l.error[i], l.geometric[i], shading[i], true, 0, 0, 0};
}

Material material_of(const PathLanes& l, std::size_t i) {
    return {MaterialKind::diffuse, l.reflectance[i]};
}

/// sample_rectangle with settings that the compiler knows or, if not `Usual`, does not.
template <bool Usual>
[[gnu::flatten]] void sample_rectangle_as_set(PathLanes& l, const Light& rectangle,
                                              const PathSettings& path, std::size_t n) {
    // Copies number by number: a whole struct's copy would stay in memory.
    PathSettings settings;
    if constexpr (!Usual) {
        settings.estimator = path.estimator;
        settings.hemisphere = path.hemisphere;
        settings.light_sampling = path.light_sampling;
    }
    Light light;
    light.emission = {rectangle.emission.r, rectangle.emission.g, rectangle.emission.b};
    light.origin = {rectangle.origin.x, rectangle.origin.y, rectangle.origin.z};
    light.edge1 = {rectangle.edge1.x, rectangle.edge1.y, rectangle.edge1.z};
    light.edge2 = {rectangle.edge2.x, rectangle.edge2.y, rectangle.edge2.z};
    light.normal = {rectangle.normal.x, rectangle.normal.y, rectangle.normal.z};
    light.area = rectangle.area;
    light.probability = rectangle.probability;
    const float slack = detail::slack_of(light);
    const std::size_t end = whole_vectors(n);
    for (std::size_t i = 0; i < end; ++i) {
        bool sound = false;
        const Vertex v = vertex_of(l, l.geometric, i);
        const LightSample s = detail::sample_rectangle_in_float(
            light, slack, v.position, {l.light_u.x[0][i], l.light_u.x[1][i]},
            settings.light_sampling, sound);
        const DirectLight direct = finish_direct(s, light.probability, v, l.wo[i], l.throughput[i],
                                                 material_of(l, i), settings);
        l.flag[i] = direct.counts ? 1 : 0;
        l.next_origin.set(i, direct.shadow.origin);
        l.next_direction.set(i, direct.shadow.direction);
        l.light.set(i, direct.radiance);
        l.exception[i] = sound ? 0 : 1;
    }
}

} // namespace

[[gnu::flatten]] void draw_numbers(const PathLanes& l, const SamplerSettings& sampler,
                                   std::uint32_t group, std::size_t n, SampleLanes& numbers) {
    const std::uint64_t seed = sampler.seed;
    const std::size_t end = whole_vectors(n);
    const auto loop = [&](auto kind, auto index_bits) {
        for (std::size_t i = 0; i < end; ++i) {
            const std::uint32_t index = l.sample[i] & index_bits(); // known zeros save look-ups
            const Sample4 s = Sampler(kind(), seed, l.pixel[i], index).group(group);
            numbers.x[0][i] = s.x[0];
            numbers.x[1][i] = s.x[1];
            numbers.x[2][i] = s.x[2];
            numbers.x[3][i] = s.x[3];
        }
    };
    using SomeBits = std::integral_constant<std::uint32_t, 0xffffu>;
    using AllBits = std::integral_constant<std::uint32_t, 0xffffffffu>;
    with_constant<SamplerKind::sobol, SamplerKind::independent>(sampler.kind, [&](auto kind) {
        if (sampler.spp <= SomeBits::value)
            loop(kind, SomeBits{});
        else
            loop(kind, AllBits{});
    });
}

[[gnu::flatten]] void aim_camera(PathLanes& l, const RenderJob& render_job, std::size_t n) {
    const RenderJob job = render_job; // a copy, which no lane can overwrite
    const std::size_t end = whole_vectors(n);
    for (std::size_t i = 0; i < end; ++i) {
        const CameraSample camera = camera_sample(job, job.filter, l.pixel_x[i], l.pixel_y[i],
                                                  {l.direction_u.x[0][i], l.direction_u.x[1][i]});
        l.next_direction.set(i, camera.ray.direction);
        l.wo.set(i, PathSteps<box_profile>::start(camera.ray).wo);
        l.weight[i] = camera.weight;
    }
}

[[gnu::flatten]] void interact_flat(PathLanes& l, std::size_t n) {
    const std::size_t end = whole_vectors(n);
    for (std::size_t i = 0; i < end; ++i) {
        bool sliver = false;
        const Vertex v = seen_from<box_profile>(
            detail::interact_triangle({l.corner[0][i], l.corner[1][i], l.corner[2][i]}, l.u[i],
                                      l.v[i], sliver),
            l.wo[i]);
        l.position.set(i, v.position);
        l.error.set(i, v.error);
        l.geometric.set(i, v.geometric);
        l.front[i] = v.front ? 1 : 0;
        l.exception[i] = sliver ? 1 : 0;
    }
}

void sample_rectangle(PathLanes& l, const Light& light, const PathSettings& path, std::size_t n) {
    constexpr PathSettings usual;
    if (path.estimator == usual.estimator && path.hemisphere == usual.hemisphere &&
        path.light_sampling == usual.light_sampling)
        sample_rectangle_as_set<true>(l, light, path, n);
    else
        sample_rectangle_as_set<false>(l, light, path, n);
}

[[gnu::flatten]] void scatter_lanes(PathLanes& l, const Vec3Lanes& shading,
                                    HemisphereSampling hemisphere_sampling, std::uint32_t first,
                                    std::size_t n) {
    const std::size_t end = whole_vectors(n);
    with_constant<HemisphereSampling::cosine, HemisphereSampling::uniform>(
        hemisphere_sampling, [&](auto hemisphere) {
            for (std::size_t i = 0; i < end; ++i) {
                const Scattered next = scatter_from(
                    vertex_of(l, shading, i), l.wo[i], l.throughput[i], material_of(l, i),
                    hemisphere(), {l.direction_u.x[first][i], l.direction_u.x[first + 1][i]});
                l.flag[i] = next.lives ? 1 : 0;
                l.next_origin.set(i, next.origin);
                l.next_direction.set(i, next.direction);
                l.throughput.set(i, next.throughput);
                l.pdf[i] = next.pdf;
            }
        });
}

} // namespace plumb
