/// \file  Many paths at a time: the steps of path_steps.h as loops over lanes, the rays as streams.
///
/// The same numbers as trace_path, bit by bit: each path takes the same steps with the same
/// arithmetic, and its contributions are added in the same order. What differs is that a step is
/// done for all paths before the next one, so that rays that run alike meet the tree together, and
/// that most steps are vector instructions (lane_loops.h).
#pragma once

#include "accel/intersector.h"
#include "renderer/integrate/film.h"
#include "renderer/integrate/lane_loops.h"
#include "renderer/integrate/path_sharing.h"

#include <memory>
#include <span>

namespace plumb {

/// A batch of paths of one thread.
template <Features F> class PathStream {
  public:
    /// All must outlive it.
    PathStream(const RenderJob& job, const Intersector& intersector)
        : job_(job), intersector_(intersector), steps_(job.scene, job.path),
          lanes_(std::make_unique<PathLanes>()),
          sharing_(job.path.reuse > 1 ? std::make_unique<PathSharing>() : nullptr) {
        if (sharing_)
            sharing_->clear(max_lanes);
    }

    [[nodiscard]] bool full() const { return count_ == max_lanes; }
    [[nodiscard]] std::size_t room() const { return max_lanes - count_; }

    /// Adds the path of sample `index` of pixel (x, y) to the batch, which must not be full.
    void add(int x, int y, std::uint32_t index) {
        lanes_->pixel_x[count_] = x;
        lanes_->pixel_y[count_] = y;
        lanes_->first_sample[count_] = index;
        ++count_;
    }

    /// With job.path.reuse: the paths added since the last call are one of each pixel of a block.
    void end_group() { sharing_->end_group(count_); }

    /// Traces the batch, adds the samples to their pixels in the order in which they came, and
    /// starts an empty one.
    void trace(Film& film, RayCounts& counts) {
        start();
        std::size_t living = count_;
        for (int depth = 1; living > 0; ++depth) {
            (depth == 1 ? counts.camera : counts.bounce) += living;
            living = arrive(living, depth);
            emit(living, depth);
            if (depth == job_.path.max_depth)
                break;
            draw_numbers(*lanes_, job_.sampler, direction_group(depth), living,
                         lanes_->direction_u);
            if (steps_.uses_light_group(depth))
                draw_numbers(*lanes_, job_.sampler, light_group(depth), living, lanes_->light_u);
            if (steps_.samples_lights())
                counts.shadow += add_direct_light(living, depth);
            living = scatter(living, depth);
        }
        if (sharing_) {
            counts.shadow += sharing_->share(intersector_, job_.path.hemisphere, *lanes_);
            sharing_->clear(count_);
        }
        for (std::size_t i = 0; i < count_; ++i)
            film.pixel(lanes_->pixel_x[i], lanes_->pixel_y[i])
                .add(lanes_->radiance[i] * lanes_->weight[i], film.with_variance());
        count_ = 0;
    }

  private:
    /// Whether vertices and light samples are plain enough for loops without branches.
    static constexpr bool flat = !F.spheres && !F.smooth_normals;
    static constexpr bool one_rectangle = F == box_profile;

    [[nodiscard]] Path path_of(std::size_t i) const {
        const PathLanes& l = *lanes_;
        return {{}, l.wo[i], l.throughput[i], l.pdf[i], {l.from[i], l.from_normal[i]}};
    }

    [[nodiscard]] Vertex vertex_of(std::size_t i) const {
        const PathLanes& l = *lanes_;
        const Vec3 geometric = l.geometric[i];
        return {l.position[i],   l.error[i],
                geometric,       F.smooth_normals ? l.shading[i] : geometric,
                l.front[i] != 0, l.surface[i],
                l.primitive[i],  l.material[i]};
    }

    void set_vertex(std::size_t i, const Vertex& v) {
        PathLanes& l = *lanes_;
        l.position.set(i, v.position);
        l.error.set(i, v.error);
        l.geometric.set(i, v.geometric);
        if constexpr (F.smooth_normals)
            l.shading.set(i, v.shading);
        l.front[i] = v.front ? 1 : 0;
    }

    /// Adds what a path finds at the vertex of this depth: radiance that the vertex emits towards
    /// the last one, or that it reflects there.
    void add_emitted(std::size_t slot, Rgb radiance, int depth) {
        if (sharing_ && depth > 2)
            sharing_->add(slot, radiance);
        else
            lanes_->radiance.set(
                slot, lanes_->radiance[slot] +
                          (sharing_ && depth == 2 ? sharing_->own(slot) * radiance : radiance));
    }
    void add_reflected(std::size_t slot, Rgb radiance, int depth) {
        if (sharing_ && depth > 1)
            sharing_->add(slot, radiance);
        else
            lanes_->radiance.set(slot, lanes_->radiance[slot] + radiance);
    }

    /// Camera rays.
    void start() {
        PathLanes& l = *lanes_;
        for (std::size_t i = 0; i < count_; ++i) {
            l.slot[i] = l.source[i] = static_cast<std::uint32_t>(i);
            l.pixel[i] = pixel_number(job_, l.pixel_x[i], l.pixel_y[i]);
            l.sample[i] = l.first_sample[i];
            l.radiance.set(i, {});
            l.throughput.set(i, {1, 1, 1});
        }
        draw_numbers(l, job_.sampler, 0, count_, l.direction_u);
        aim_camera(l, job_, count_);
        const Camera& camera = job_.scene.camera;
        for (std::size_t i = 0; i < count_; ++i)
            l.rays[i] = {camera.origin, camera.near_clip, l.next_direction[i], camera.far_clip};
    }

    /// Traces the rays to their next vertices; paths that meet nothing get the environment and
    /// leave. Returns how many go on; they are closed up.
    std::size_t arrive(std::size_t ray_count, int depth) {
        PathLanes& l = *lanes_;
        intersector_.closest(std::span<const Ray>(l.rays.lane, ray_count),
                             std::span<Hit>(l.hits.lane, ray_count));
        std::size_t n = 0;
        for (std::size_t r = 0; r < ray_count; ++r) {
            const std::size_t i = l.source[r]; // n <= r <= i: nothing is overwritten too early
            const Ray& ray = l.rays[r];
            const Hit& hit = l.hits[r];
            Path path{ray,
                      depth == 1 ? l.wo[i] : -ray.direction,
                      l.throughput[i],
                      l.pdf[i],
                      {l.position[i], {}}};
            if constexpr (F.environment)
                path.from.normal = l.geometric[i];
            if (!hit.valid()) {
                if constexpr (F.environment)
                    add_emitted(l.slot[i], steps_.environment(path, depth), depth);
                continue;
            }
            l.ray[n] = static_cast<std::uint32_t>(r);
            l.slot[n] = l.slot[i];
            l.pixel[n] = l.pixel[i];
            l.sample[n] = l.sample[i];
            l.throughput.set(n, path.throughput);
            l.pdf[n] = path.pdf;
            l.wo.set(n, path.wo);
            l.from.set(n, path.from.position);
            if constexpr (F.environment)
                l.from_normal.set(n, path.from.normal);
            if constexpr (flat)
                gather(n, hit);
            else
                set_vertex(n, steps_.vertex_at(hit, path));
            l.surface[n] = F.spheres ? job_.scene.surface_of(hit) : hit.geometry;
            l.primitive[n] = hit.primitive;
            ++n;
        }
        if constexpr (flat)
            interact(n);
        if (sharing_ && depth == 2)
            for (std::size_t i = 0; i < n; ++i)
                sharing_->reach_second(l, i, !F.smooth_normals || !has_normals(l.surface[i]));
        return n;
    }

    void gather(std::size_t i, const Hit& hit) {
        PathLanes& l = *lanes_;
        const TriangleVertices t = job_.scene.geometry.vertices(hit.geometry, hit.primitive);
        l.corner[0].set(i, t.a);
        l.corner[1].set(i, t.b);
        l.corner[2].set(i, t.c);
        l.u[i] = hit.u;
        l.v[i] = hit.v;
    }

    /// Vertices on flat triangles.
    void interact(std::size_t n) {
        PathLanes& l = *lanes_;
        interact_flat(l, n);
        for (std::size_t i = 0; i < n; ++i)
            if (l.exception[i] != 0) {
                const TriangleVertices t{l.corner[0][i], l.corner[1][i], l.corner[2][i]};
                const Vec3 direction = l.rays[l.ray[i]].direction;
                set_vertex(i, seen_from<F>(detail::interact_triangle(t, l.u[i], l.v[i], direction),
                                           l.wo[i]));
            }
    }

    /// The loops over lanes know no other material: a new kind has to be thought of here.
    [[nodiscard]] static Rgb reflectance_of(const Material& material) {
        switch (material.kind) {
        case MaterialKind::diffuse: return material.reflectance;
        }
        return {};
    }

    /// Adds what the vertices emit, and looks up what they are made of.
    void emit(std::size_t n, int depth) {
        PathLanes& l = *lanes_;
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint32_t surface = l.surface[i];
            if (job_.scene.surface_lights[surface].first != invalid_id)
                add_emitted(l.slot[i], steps_.emission(path_of(i), vertex_of(i), depth), depth);
            const std::uint32_t material = steps_.material_of(surface, l.front[i] != 0);
            l.material[i] = material;
            l.reflectance.set(
                i, material == invalid_id ? Rgb{} : reflectance_of(job_.scene.materials[material]));
        }
    }

    /// Next-event estimation for all; returns the number of shadow rays.
    std::size_t add_direct_light(std::size_t n, int depth) {
        PathLanes& l = *lanes_;
        if constexpr (one_rectangle) {
            sample_rectangle(l, job_.scene.lights[0], job_.path, n);
            for (std::size_t i = 0; i < n; ++i) {
                l.next_tmax[i] = shadow_end;
                if (l.exception[i] != 0)
                    set_direct(i, direct_light(i));
            }
        } else {
            for (std::size_t i = 0; i < n; ++i)
                set_direct(i, direct_light(i));
        }
        std::size_t rays = 0;
        for (std::size_t i = 0; i < n; ++i) {
            if (l.flag[i] == 0)
                continue;
            l.rays[rays] = {l.next_origin[i], 0, l.next_direction[i], l.next_tmax[i]};
            l.source[rays] = static_cast<std::uint32_t>(i);
            ++rays;
        }
        intersector_.occluded(std::span<const Ray>(l.rays.lane, rays),
                              std::span<std::uint8_t>(l.blocked.lane, rays));
        for (std::size_t r = 0; r < rays; ++r) {
            const std::size_t i = l.source[r];
            if (l.blocked[r] == 0)
                add_reflected(l.slot[i], l.light[i], depth);
        }
        return rays;
    }

    void set_direct(std::size_t i, const DirectLight& direct) {
        PathLanes& l = *lanes_;
        l.flag[i] = direct.counts ? 1 : 0;
        l.next_origin.set(i, direct.shadow.origin);
        l.next_direction.set(i, direct.shadow.direction);
        l.next_tmax[i] = direct.shadow.tmax;
        l.light.set(i, direct.radiance);
    }

    [[nodiscard]] DirectLight direct_light(std::size_t i) const {
        const PathLanes& l = *lanes_;
        if (l.material[i] == invalid_id)
            return {};
        return steps_.direct_light(path_of(i), vertex_of(i), {l.light_u.x[0][i], l.light_u.x[1][i]},
                                   l.light_u.x[2][i]);
    }

    /// New directions. Returns how many paths go on; their rays are closed up.
    std::size_t scatter(std::size_t n, int depth) {
        PathLanes& l = *lanes_;
        const Vec3Lanes& shading = F.smooth_normals ? l.shading : l.geometric;
        scatter_lanes(l, shading, job_.path.hemisphere, first_of_direction(depth), n);
        std::size_t rays = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const bool shared = sharing_ && depth == 1;
            if (shared)
                sharing_->leave_first(l, shading, i);
            if (l.flag[i] == 0)
                continue;
            const Rgb own = l.throughput[i];
            if (steps_.roulette_plays(depth)) {
                Rgb throughput = own;
                if (!steps_.survives(throughput, depth, l.light_u.x[3][i]))
                    continue;
                l.throughput.set(i, throughput);
            }
            if (shared) { // roulette's share stays with what is shared
                const float rest = max_component(l.throughput[i]) / max_component(own);
                sharing_->set_own(l.slot[i], own);
                l.throughput.set(i, {rest, rest, rest});
            }
            l.rays[rays] = {l.next_origin[i], 0, l.next_direction[i], infinity};
            l.source[rays] = static_cast<std::uint32_t>(i);
            ++rays;
        }
        return rays;
    }

    [[nodiscard]] bool has_normals(std::uint32_t surface) const {
        const auto& normals = job_.scene.normals; // of meshes; spheres come after them
        return surface < normals.size() && !normals[surface].empty();
    }

    const RenderJob& job_;
    const Intersector& intersector_;
    PathSteps<F> steps_;
    std::unique_ptr<PathLanes> lanes_;
    std::unique_ptr<PathSharing> sharing_; ///< null: each pixel has its paths for itself
    std::size_t count_ = 0;
};

} // namespace plumb
